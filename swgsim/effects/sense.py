"""Sign of a speed without a jump, so that an integrator can follow."""

import numpy as np

# The sign changes smoothly below this speed [rad/s], far below the speed of any operating point.
SMOOTHING_SPEED = 1e-3


def sense(speed: np.ndarray, small: float = SMOOTHING_SPEED) -> np.ndarray:
    """Smooth sign of a speed, from -1 to 1; the friction of eq. (5) has the sign of the sliding speed of eq. (6)."""
    return np.tanh(speed / small)
