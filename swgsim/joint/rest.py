"""How far the textbook model itself is certain, row by row, and the fit that takes account of it."""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Fit, fit
from swgsim.joint.textbook import Friction, RigidBody

# Median of the square of a standard normal number.
MEDIAN_OF_SQUARE = 0.4549


def trusted(textbook: Fit) -> Fit:
    """The textbook model, fitted by generalised least squares: rows count by the inverse of their variance.

    Two torques of the textbook lie in an interval, and no function of the recorded motion says where. Their variance is
    that of a uniform distribution, a twelfth of the square of the interval, besides that of the noise.

    - Coulomb friction of a joint at rest has any value within plus and minus its size. One standstill is one such
      number, however many samples it has: n samples say no more of the mean than one, so each has n times the variance.
    - The load where it jumps: speed and signal pass filters, so that its time is known to the lag between both only.
    """
    table = textbook.table
    friction = next((term for term in textbook.terms if isinstance(term, Friction)), None)
    rigid = next(term for term in textbook.terms if isinstance(term, RigidBody))
    rest, interval = (np.concatenate(each) for each in zip(*(_unknown(rigid, r) for r in table.recordings), strict=True))
    square, moves = textbook.residual**2, rest < 0.5
    noise = float(np.median(square[moves])) / MEDIAN_OF_SQUARE
    variance = interval**2 / 12
    if friction and not moves.all():
        size = min((2 * friction.weights[0]) ** 2 / 12, float(square[~moves].mean() - square[moves].mean()))
        variance += _alike(textbook, moves) * rest * max(size, 0.0)
    return fit(replace(table, trust=np.sqrt(noise / (noise + variance))), textbook.terms)


def _unknown(
    rigid: RigidBody, recording: JointRecording
) -> tuple[Float[np.ndarray, " time"], Float[np.ndarray, " time"]]:
    """How far the joint rests, from 0 to 1, and the interval of its load, within the time that is not resolved."""
    size = 2 * int(np.ceil(abs(rigid.lag) * recording.rate) + 1) + 1
    load = rigid.signal(recording)
    return maximum_filter1d(recording.rest, size), maximum_filter1d(load, size) - minimum_filter1d(load, size)


def _alike(textbook: Fit, moves: Bool[np.ndarray, " row"]) -> float:
    """Independent errors in a stretch of a moving joint: the mean square of the errors over that of their means."""
    stretch, residual = textbook.table.stretch[moves], textbook.residual[moves]
    rows = np.bincount(stretch)
    sums = np.bincount(stretch, residual)[rows > 0]
    return float((residual**2).mean() / (sums**2 / rows[rows > 0]).sum() * len(residual))
