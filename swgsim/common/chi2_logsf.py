"""Probabilities far out in the tail of a chi-squared distribution, where SciPy has run out of numbers."""

import numpy as np
from scipy.special import chdtrc, gammaln


def log_tail(value: np.ndarray | float, freedom: np.ndarray | int) -> np.ndarray:
    """Logarithm of the probability that noise gives a sum of squares of at least this value.

    >>> float(log_tail(2000.0, 2))
    -1000.0
    """
    value, freedom = np.broadcast_arrays(np.asarray(value, float), np.asarray(freedom, float))
    with np.errstate(divide="ignore"):
        near = np.log(chdtrc(freedom, value))
    half = np.maximum(value, 1e-300) / 2
    # Leading terms of the incomplete gamma function; exact for two degrees of freedom.
    far = -half + (freedom / 2 - 1) * np.log(half) - gammaln(freedom / 2)
    return np.where(np.isfinite(near) & (near > -300), near, np.minimum(far, 0.0))


def surprise(value: float, freedom: int) -> float:
    """How unlikely a sum of squares is by luck: the sum of two squares that is as unlikely; 0 of no freedom at all.

    >>> surprise(2000.0, 2), surprise(0.0, 0)
    (2000.0, 0.0)
    """
    return -2 * float(log_tail(value, freedom)) if freedom else 0.0
