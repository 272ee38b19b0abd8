"""Quantities from the motion of a joint: smoothed speed, acceleration, direction of friction."""

import numpy as np
from jaxtyping import Float
from scipy.signal import savgol_filter

from swgsim.effects.sense import sense

# Window of the smoothing of speeds [s]; trajectories and speed controls are slower.
SMOOTHED = 0.15
# Friction changes its sign smoothly below this speed of the output [rad/s], the noise of a measured speed.
CREEP = 0.01


def smooth(omega: Float[np.ndarray, " time"], rate: float, derivative: int) -> Float[np.ndarray, " time"]:
    """A smoothed speed, or its derivative."""
    length = max(5, int(SMOOTHED * rate) // 2 * 2 + 1)
    length = min(length, (len(omega) - 1) // 2 * 2 + 1)
    return savgol_filter(omega, length, 2, deriv=derivative, delta=1 / rate)


def direction(omega: Float[np.ndarray, " time"]) -> Float[np.ndarray, " time"]:
    """Sign of Coulomb friction, from -1 to 1."""
    return sense(omega, CREEP)


def play(values: Float[np.ndarray, " time"], width: float) -> Float[np.ndarray, " time"]:
    """An element of Maxwell's slip model, from -1 to 1: a spring that slips at the strain ``width``.

    It begins unstrained, because the motion before the recording is unknown.
    """
    found, z = [0.0], 0.0
    for step in (np.diff(values) / width).tolist():
        z += step
        if z > 1.0:
            z = 1.0
        elif z < -1.0:
            z = -1.0
        found.append(z)
    return np.array(found)
