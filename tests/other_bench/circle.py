"""Angles around the flex spline, and functions of them as values or as Fourier coefficients."""

import numpy as np
from jaxtyping import Complex, Float

# Highest circumferential order of the shell.
ORDERS = 32
# Points around the circumference, X of them counted from the major axis of the wave generator [rad].
POINTS = 128
X = 2 * np.pi * np.arange(POINTS) / POINTS
STEP = float(X[1])
ORDER = np.fft.fftfreq(POINTS, 1 / POINTS)
# Angles of the wave generator at which the flex spline is solved [rad], and THETA (psi, x), the points fixed to the
# flex spline that lie at X then.
PSI = 2 * np.pi * np.arange(64) / 64
THETA = X + PSI[:, None]


def wrapped(angle: Float[np.ndarray, "*any"]) -> Float[np.ndarray, "*any"]:
    """The angle between -pi and pi."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def coefficients(values: Float[np.ndarray, "*any x"]) -> Complex[np.ndarray, "*any x"]:
    """Fourier coefficients of the orders ORDER."""
    return np.fft.fft(values, axis=-1) / POINTS


def both_signs(c: Complex[np.ndarray, " order"]) -> Complex[np.ndarray, " x"]:
    """Coefficients of a real function of the orders ORDER, from those of 0 to ORDERS."""
    whole = np.zeros(POINTS, complex)
    whole[: ORDERS + 1] = c
    whole[-ORDERS:] = np.conj(c[:0:-1])
    return whole


def circulant(c: Complex[np.ndarray, " x"]) -> Float[np.ndarray, "x x"]:
    """Matrix that takes values of a load to those of the response whose orders are `c` times those of the load."""
    h = np.fft.ifft(c).real
    i = np.arange(POINTS)
    return h[(i[:, None] - i) % POINTS]
