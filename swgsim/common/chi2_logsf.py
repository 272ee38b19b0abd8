"""Tail probabilities of chi-squared distributions, also where they are too small for a float."""

import numpy as np
from scipy.special import chdtrc, gammaln


def log_tail(value: np.ndarray | float, freedom: np.ndarray | int) -> np.ndarray:
    """Logarithm of the survival function of chi-squared: noise gives a sum of squares of at least this value.

    Parameters
    ----------
    value : array
        Sum of squares, in units of the noise variance.
    freedom : array
        Degrees of freedom.

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
    """Chi-squared value with two degrees of freedom of the same p-value; 0 for no degrees of freedom.

    >>> surprise(2000.0, 2), surprise(0.0, 0)
    (2000.0, 0.0)
    """
    return -2 * float(log_tail(value, freedom)) if freedom else 0.0
