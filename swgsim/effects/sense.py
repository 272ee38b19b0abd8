"""Which way something turns, without a jump, so that an integrator can follow."""

import numpy as np

# The sense changes smoothly below this speed [rad/s], far under that of any operating point.
SMALL = 1e-3


def sense(speed: np.ndarray, small: float = SMALL) -> np.ndarray:
    """From -1 to 1, as the friction of eq. (5) changes its sign with the sliding speed."""
    return np.tanh(speed / small)
