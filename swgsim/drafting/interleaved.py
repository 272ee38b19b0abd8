"""Signals that follow one another in one column, which a smooth motion tells from a single one."""

import numpy as np
from jaxtyping import Shaped

# Robots have fewer axes.
MOST_AXES = 16
# Median change to the sample of the same signal against that to the next number. Samples of one smooth signal change
# least from one to the next, whatever its rate: then the ratio is above 1.
SMOOTHER = 0.2


def interleaved_in(values: Shaped[np.ndarray, " number"]) -> int:
    """How many signals follow one another in a column; 1 for a single signal.

    >>> interleaved_in(np.column_stack([np.sin(np.arange(99) / 20) + place for place in range(3)]).ravel())
    3
    """
    numbers = values.astype(float)
    if len(numbers) < 4 * MOST_AXES:
        return 1
    change = [float(np.mean(np.abs(numbers[lag:] - numbers[:-lag]))) for lag in range(1, MOST_AXES + 1)]
    lag = int(np.argmin(change)) + 1
    return lag if change[lag - 1] < SMOOTHER * change[0] else 1
