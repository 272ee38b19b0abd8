"""How far the textbook model itself is certain, row by row, and the fit that takes account of it."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Fit, fit
from swgsim.joint.textbook import Friction, RigidBody

# Median of the square of a standard normal number.
MEDIAN_OF_SQUARE = 0.4549


def weighted_by_variance(textbook: Fit) -> Fit:
    """The textbook model, fitted by generalised least squares: rows count by the inverse of their variance.

    Two torques of the textbook lie in an interval, and no function of the recorded motion says where. Their variance is
    that of a uniform distribution, a twelfth of the square of the interval, besides that of the noise.

    - Coulomb friction of a joint at rest has any value within plus and minus its size. A standstill is one such number,
      however many samples it has: n samples say no more of the mean than one, so each has n times the variance.
    - The torque of inertia where the acceleration jumps, which is computed from the speed: speed and signal pass
      filters, so that the time of the jump is known to the lag between both only.

    Each is taken if it makes the errors more likely than equal ones: friction that is elastic predicts a joint at rest
    as in motion, and a smooth motion does not jump.
    """
    table = textbook.table
    friction = next((term for term in textbook.terms if isinstance(term, Friction)), None)
    rigid = next(term for term in textbook.terms if isinstance(term, RigidBody))
    width = friction.sign_width if friction and any(each.reverses for each in table.recordings) else 0.0
    rest = np.concatenate([each.rest(width, rigid.lag) for each in table.recordings])
    stands = rest > 0.5
    square = textbook.residual**2
    # Few errors of the motion are large: those of a load that jumps.
    noise = float(np.median(square[~stands])) / MEDIAN_OF_SQUARE
    at_rest, moving = square[stands], square[~stands]
    load = np.concatenate([_of_load(rigid, each) for each in table.recordings])
    jumps = _surprise(moving, noise + load[~stands]) < _surprise(moving, moving.mean())
    variance = load if jumps else np.zeros(len(load))
    if friction and stands.any():
        held = (2 * friction.weights[0]) ** 2 / 12
        if _surprise(at_rest, moving.mean() + held) < _surprise(at_rest, moving.mean()):
            variance = variance + np.bincount(table.stretch, rest)[table.stretch] * rest * held
    return fit(replace(table, trust=np.sqrt(noise / (noise + variance))), textbook.terms)


def _surprise(square: Float[np.ndarray, " row"], variance: Float[np.ndarray, " row"] | float) -> float:
    """Mean of twice the negative logarithm of the likelihood of normal errors, but for a constant."""
    return float(np.mean(square / variance + np.log(variance)))


def _of_load(rigid: RigidBody, recording: JointRecording) -> Float[np.ndarray, " time"]:
    """Variance of the torque of inertia from what it changes within the time that is not resolved."""
    inertia = sum(weight for name, weight in zip(rigid.names(), rigid.weights, strict=True) if "inertia" in name)
    size = 2 * int(np.ceil(abs(rigid.lag) * recording.rate) + 1) + 1
    acceleration = recording.acceleration
    return (inertia * (maximum_filter1d(acceleration, size) - minimum_filter1d(acceleration, size))) ** 2 / 12
