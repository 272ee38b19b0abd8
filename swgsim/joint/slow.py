"""The part of a residual below 5 Hz, where gravity, inertia and friction act; above are ripples and noise."""

import numpy as np
from jaxtyping import Float
from scipy.signal import butter, sosfiltfilt

from swgsim.joint.regression import Table

# Corner frequency [Hz].
SLOW = 5.0


def slow(table: Table, residual: Float[np.ndarray, " row"]) -> Float[np.ndarray, " row"]:
    """The part of a residual below SLOW; the whole residual of a recording that is too coarse or too short."""
    found = residual.copy()
    for number, each in enumerate(table.recordings):
        if each.rate > 4 * SLOW and len(each) > 100:
            own = table.run == number
            found[own] = sosfiltfilt(butter(4, SLOW, fs=each.rate, output="sos"), residual[own])
    return found
