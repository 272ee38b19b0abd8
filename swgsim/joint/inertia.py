"""Inertia of a joint about an upright axis, which changes with the reach of the links beyond it."""

from itertools import combinations_with_replacement

import numpy as np
from jaxtyping import Float

# Share of the rigid-body torque that the inertia must explain.
EXPLAINED = 0.8
# Least inertia, as a share of the mean: a fit may go below in postures with few samples.
LEAST = 0.1


def inertia(
    reach: Float[np.ndarray, "link time"],
    speed: Float[np.ndarray, " time"],
    acceleration: Float[np.ndarray, " time"],
    time: Float[np.ndarray, " time"],
    torque: Float[np.ndarray, " time"],
) -> Float[np.ndarray, " time"] | None:
    """Inertia [kg m^2] whose momentum changes at the rate of a rigid-body torque; None if there is none.

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
    if not left @ left < (1 - EXPLAINED) * (torque @ torque) or found.mean() <= 0:
        return None
    return np.maximum(found, LEAST * found.mean())
