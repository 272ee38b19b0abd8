"""The beat: the part of the kinematic error that turns with the circular spline.

Its source is physics.md 1.2. One part of the kinematic error turns with the wave generator and has its orders n. The
other part turns with the circular spline. It has n (1 - 1 / (N + 1)) waves per revolution, so its phase drifts against
the recorded angle. Where it begins depends on the angle of the output, which is not recorded: the phase is another one
in every recording. A recording of 12 revolutions cannot tell both parts from each other.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from jaxtyping import Complex

from swgsim.identification.data.features import DENSE, FITTED, ORDERS, fitted_columns
from swgsim.recordings.recording import Recording

# Waves of the kinematic error per revolution of the wave generator (physics.md 1.2).
OF_ERROR = (1, 2, 4)
# Flanks and springs are not linear, so two waves also make one at the sum of their orders, which drifts as it would.
BEATING = tuple(sorted({*OF_ERROR, *(one + other for one in OF_ERROR for other in OF_ERROR)}))
# The two lobes carry the torque past the gauges, which so see a wave at these orders beside its own, too.
BY_LOBES = (-2, 0, 2)


def behind(order: int, N: int) -> float:
    """Waves per revolution by which the part of the circular spline stays behind that of the wave generator."""
    return order / (N + 1)


def beat_orders(N: int) -> list[float]:
    """Orders of the recorded angle at which the beat lies in torques and gauges of a gear of ratio N.

    Those at sums of orders are left out: in the gauges of the paper's gear 1 they are below 0.06 µV/V.
    """
    return [abs(order + lobes - behind(order, N)) for order in OF_ERROR for lobes in BY_LOBES]


def drifting(recordings: Sequence[Recording], N: int) -> Complex[np.ndarray, "recording beat one one"]:
    """Features that fit a wave that stays behind by as much as each of :data:`BEATING`.

    Parameters
    ----------
    recordings : sequence of Recording
        In a planned recording, which has no samples, the wave does not drift.
    N : int

    Returns
    -------
    array (recording, beat, one, one)
        By them, features f_c and f_s of what a cosine and a sine of the kinematic error make become the real and the
        imaginary part of the product with f_c - i f_s: of a beat with a phase of 0, and of one with a phase of 90 deg.
    """
    return np.array([_drifting(each.channels.get("phi_in", np.empty(0)).tobytes(), N) for each in recordings])


@lru_cache(maxsize=256)  # the same recordings are fitted many times
def _drifting(angle: bytes, N: int) -> Complex[np.ndarray, "beat one one"]:
    phi = np.frombuffer(angle)
    if len(phi) < DENSE:
        return np.tile(np.eye(2 * ORDERS + 1, dtype=complex), (len(BEATING), 1, 1))
    columns = fitted_columns(phi)
    kept = np.concatenate([np.arange(ORDERS + 1), FITTED + 1 + np.arange(ORDERS)])
    fitting = np.linalg.solve(columns.T @ columns, columns.T)[kept]
    turned = [np.exp(1j * behind(order, N) * (phi - phi.mean()))[:, None] for order in BEATING]
    return np.array([fitting @ (turn * columns[:, kept]) for turn in turned])
