"""Quantities from the motion of a joint: smoothed speed, acceleration, slip, and inertia about an upright axis."""

from itertools import combinations_with_replacement

import numpy as np
from jaxtyping import Float
from scipy.ndimage import uniform_filter1d
from scipy.signal import savgol_coeffs, savgol_filter

# Window of the smoothing of speeds [s]; trajectories and speed controls are slower.
SMOOTHING_WINDOW = 0.15
# Share of the rigid-body torque that the inertia must explain.
LEAST_RIGID_SHARE = 0.8
# Least inertia, as a share of the mean: a fit may go below in postures with few samples.
LEAST_INERTIA = 0.1


def smooth(omega: Float[np.ndarray, " time"], rate: float, derivative: int) -> Float[np.ndarray, " time"]:
    """A smoothed speed, or its derivative."""
    return savgol_filter(omega, window(len(omega), rate), 2, deriv=derivative, delta=1 / rate)


def least_doubt(
    omega: Float[np.ndarray, " time"], rate: float, derivative: int = 0
) -> tuple[Float[np.ndarray, " time"], float]:
    """A speed or its derivative, smoothed over the window that leaves the least error, and the error [rad/s, rad/s^2].

    A longer window averages more noise, but rounds a motion that changes within it. The estimate of the error is that
    of Stein (1981, Ann. Stat. 9, 1135): a smoothing with the coefficients c leaves c^2 s^2 of white noise with variance
    s^2. From the shortest one, which takes nothing from the motion, it differs by (c - shortest)^2 s^2 for the noise;
    the rest of the mean square of the difference is what it takes from the motion. Third differences show the noise.
    """
    s2 = float(np.mean(np.diff(omega, 3) ** 2)) / 20
    shortest = 1 if derivative == 0 else 3
    if derivative == 0:
        first, best = np.ones(1), omega
    else:
        first, best = np.array([0.5, 0.0, -0.5]) * rate, np.gradient(omega, edge_order=2) * rate
    start, least = best, float(first @ first) * s2
    for length in range(5, window(len(omega), rate) + 1, 2):
        c = savgol_coeffs(length, 2, deriv=derivative, delta=1 / rate)
        smoothed = savgol_filter(omega, length, 2, deriv=derivative, delta=1 / rate)
        off = c - np.pad(first, (length - shortest) // 2)
        rounded = float(np.mean((start - smoothed) ** 2)) - float(off @ off) * s2
        error = max(rounded, 0.0) + float(c @ c) * s2
        if error < least:
            best, least = smoothed, error
    return best, float(np.sqrt(least))


def window(samples: int, rate: float) -> int:
    """Odd number of samples of the smoothing of a speed."""
    return min(max(5, int(SMOOTHING_WINDOW * rate) // 2 * 2 + 1), (samples - 1) // 2 * 2 + 1)


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


def jitter(angle: Float[np.ndarray, " time"], size: int) -> Float[np.ndarray, " time"]:
    """Range of an angle that stands, in windows of ``size`` samples [rad]: that of its noise, and an encoder's step.

    The largest of n samples of noise is sqrt(2 ln n) standard deviations above its mean (Donoho and Johnstone, 1994,
    Biometrika 81, 425), and the smallest as far below. Third differences show the noise. It is that of the window: an
    angle whose times are uncertain has more in motion than at rest.
    """
    steps = np.abs(np.diff(angle))
    square = uniform_filter1d(np.pad(np.diff(angle, 3) ** 2 / 20, (1, 2), mode="edge"), size)
    # Sums of a filter that runs along may fall below 0 by rounding.
    noise = np.sqrt(np.maximum(square, 0.0))
    return 2 * noise * np.sqrt(2 * np.log(size)) + float(steps[steps > 0].min(initial=np.inf))


def displaced(angle: Float[np.ndarray, " time"], least: float) -> Float[np.ndarray, " time"]:
    """Direction of the last displacement by more than ``least`` [rad]: -1, 1, or 0 before the first."""
    slip = play(angle, least)
    last = np.maximum.accumulate(np.where(np.abs(slip) == 1, np.arange(len(angle)), -1))
    return np.where(last >= 0, slip[last], 0.0)


def inertia(
    reach: Float[np.ndarray, "link time"],
    speed: Float[np.ndarray, " time"],
    acceleration: Float[np.ndarray, " time"],
    time: Float[np.ndarray, " time"],
    torque: Float[np.ndarray, " time"],
) -> Float[np.ndarray, " time"] | None:
    """Inertia [kg m^2] whose momentum changes at the rate of a rigid-body torque; None if there is none.

    It is for a joint about an upright axis, and changes with the reach of the links beyond it.

    The inertia of links in a plane through the axis is a sum of squares and products of their reaches.

    Parameters
    ----------
    reach : array (link, time)
        Cosine of the angle of every link to the horizontal.
    speed, acceleration, time : array (time,)
        Of the joint [rad/s], [rad/s^2], [s].
    torque : array (time,)
        Torque of the rigid-body model [N m].
    """
    pairs = combinations_with_replacement(reach, 2)
    parts = np.stack([np.ones(len(time)), *(one * other for one, other in pairs)])
    X = (parts * acceleration + np.gradient(parts, time, axis=1) * speed).T
    weights = np.linalg.lstsq(X, torque, rcond=1e-6)[0]
    left, found = torque - X @ weights, weights @ parts
    if not left @ left < (1 - LEAST_RIGID_SHARE) * (torque @ torque) or found.mean() <= 0:
        return None
    return np.maximum(found, LEAST_INERTIA * found.mean())
