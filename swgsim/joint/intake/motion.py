"""How far a joint goes by its angle, and by its velocity."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

# Windows to a run in which the sense of rotation is looked for.
WINDOWS = 100
# Share of the whole path by which a run that never turns ends away from its start; the rest is noise of the angle.
ONE_WAY = 0.5


class Way(NamedTuple):
    """Sums over the steps of a run, each counted in the sense in which the joint turned.

    Attributes
    ----------
    by_angle : float
        [rad].
    by_velocity : float
        [rad] if steps in time were given, else [rad/s].
    """

    by_angle: float
    by_velocity: float


def way(
    q: Float[np.ndarray, " time"], omega: Float[np.ndarray, " time"], time: Float[np.ndarray, " time"] | None = None
) -> Way:
    """How far a joint went, which is the same by angle and by velocity if they agree.

    A run in one direction is taken as a whole, so that noise of the angle drops out; of a run that swings, each step
    counts with the sense of rotation around it, as its displacement says nothing.

    Parameters
    ----------
    q, omega : array (time,)
        [rad], [rad/s].
    time : array (time,), optional
        [s]; steps of 1 without it.
    """
    steps = np.diff(q)
    areas = (omega[1:] + omega[:-1]) / 2 * (1.0 if time is None else np.diff(time))
    sense = np.full(len(steps), 1.0 if q[-1] >= q[0] else -1.0)
    if abs(q[-1] - q[0]) < ONE_WAY * np.ptp(q):
        half = max(len(q) // WINDOWS // 2, 1)
        ahead = np.minimum(np.arange(len(steps)) + 1 + half, len(q) - 1)
        behind = np.maximum(np.arange(len(steps)) - half, 0)
        sense = np.sign(q[ahead] - q[behind])
    return Way(float(sense @ steps), float(sense @ areas))
