"""What presses on the band: the cam of the wave generator, and the teeth, which share the torque by depth."""

import numpy as np
from jaxtyping import Float

from other_bench.circle import STEP, THETA, X, wrapped
from other_bench.specimen import Specimen

# Torques at which the flex spline is solved [N m].
TORQUES = np.array([0.5, 7.0, 15.0, 25.0, 39.0, 55.0, 70.0, 80.0])
# How far engagement lags behind the lobes [rad/(N m)], and the share of w0 from which teeth carry at no load, which
# falls with the torque [-], [1/(N m)]: estimates.
LAG = np.radians(1.0) / 70
FIRST_DEPTH, LOWER = 0.18, 0.13 / 80
# Share of the radial force of frictionless flanks that friction leaves: an estimate.
SEPARATION = 0.9
# Width of a cracked tip: four of 200 teeth [rad].
TIP_WIDTH = np.radians(7.2)


def wave_generator(unit: Specimen) -> Float[np.ndarray, "psi x"]:
    """Radial displacement that cam and eccentricity impose [m]."""
    return cam(unit.w0, unit.hat.R) + (unit.eccentricity * np.exp(-1j * THETA)).real


def cam(w0: float, R: float) -> Float[np.ndarray, " x"]:
    """Radial displacement of an ellipse with the perimeter of the circle of radius R [m]."""
    a, b = R + w0, R - w0
    t = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    for _ in range(20):
        b += R - np.mean(np.hypot(a * np.sin(t), b * np.cos(t)))
    return a * b / np.sqrt((b * np.cos(X)) ** 2 + (a * np.sin(X)) ** 2) - R


def tooth_forces(
    unit: Specimen, wg: Float[np.ndarray, "psi x"]
) -> tuple[Float[np.ndarray, "psi torque x"], Float[np.ndarray, "psi torque x"]]:
    """Radial and circumferential force of the teeth on the band [N/rad].

    Parameters
    ----------
    unit : Specimen
    wg : array (psi, x)
        Displacement by the wave generator [m].
    """
    T = TORQUES[:, None]
    # Between points the depth is linear; the lag stays below one step.
    lag = LAG * T / STEP
    depth = wg[:, None] / unit.w0
    depth = (1 - lag) * depth + lag * np.roll(depth, 1, axis=-1)
    share = np.clip(depth - (FIRST_DEPTH - LOWER * T), 0, None)
    covered = (TIP_WIDTH / 2 + STEP / 2 - np.abs(wrapped(THETA - unit.tip.angle))) / STEP
    share *= 1 - unit.tip.share * np.clip(covered, 0, 1)[:, None]
    q = -T / unit.hat.R * share / (share.sum(axis=-1, keepdims=True) * STEP)
    return -np.abs(q) * np.tan(unit.alpha) * SEPARATION, q
