"""Strain-gauge bridges on the back of the collar (Fig. 3): from displacements to mV/V.

:func:`bridges` is the bridge equation; :func:`strain_rows` gives the strains. The layout has the symmetry of the paper:
s1 and s3, s2 and s4 are opposite pairs of +-45 degree grids. s0 is an all-round torque bridge of four such pairs
half-way between s1 to s4. In it the deflection by the wave generator cancels up to order 3.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float

from swgsim.common.checks import require, require_positive
from swgsim.flexspline.cyclic import orders
from swgsim.flexspline.lattice import INNER
from swgsim.flexspline.silk_hat import Sector
from swgsim.storage.labelled_signals import SENSORS

# Angles of the grid pairs of each sensor [rad] and the number of active bridge arms.
LAYOUT = tuple(np.pi / 4 + np.pi / 2 * np.arange(4) if s == 0 else np.array([np.pi / 2 * (s - 1)]) for s in range(5))

# Bounds of the errors of a gauge, in the units below.
LIMITS = {"gain": (0.0, 10.0), "offset": (-10.0, 10.0), "position": (-0.8, 0.8), "grid_angle": (-0.8, 0.8)}


@dataclass(frozen=True)
class GaugeSet:
    """The five bridges of one gear, with the errors that differ from gear to gear.

    Attributes
    ----------
    gauge_factor : float
    radius : float
        Radius of the grids on the collar [m]; an estimate.
    active_arms : tuple of 5 int
        2 for a half bridge, 4 for a full bridge.
    gain : tuple of 5 float
        Factor on each signal.
    offset : tuple of 5 float
        Zero of each bridge [mV/V].
    position : tuple of 5 float
        Error of the position around the collar, positive from s1 towards s2 [rad].
    grid_angle : tuple of 5 float
        Error of the grid direction [rad].
    """

    gauge_factor: float = 2.0
    radius: float = 28e-3
    active_arms: tuple[int, ...] = (4, 2, 2, 2, 2)
    gain: tuple[float, ...] = (1.0,) * 5
    offset: tuple[float, ...] = (0.0,) * 5
    position: tuple[float, ...] = (0.0,) * 5
    grid_angle: tuple[float, ...] = (0.0,) * 5

    def __post_init__(self) -> None:
        require_positive("the gauges", gauge_factor=self.gauge_factor, radius=self.radius)
        for name in ("active_arms", *LIMITS):
            if len(getattr(self, name)) != len(SENSORS):
                raise ValueError(f"{name} has {len(getattr(self, name))} values, expected one for each of {SENSORS}")
        for name, (low, high) in LIMITS.items():
            for sensor, value in zip(SENSORS, getattr(self, name), strict=True):
                require(sensor, name, value, low, high)
        if not set(self.active_arms) <= {2, 4}:
            raise ValueError(f"active_arms {self.active_arms}: 2 for a half bridge or 4 for a full bridge")


def strain_rows(sector: Sector, radius: float) -> Complex[np.ndarray, "order 3 dof"]:
    """Strains on the back of the collar at angle 0 per nodal displacement of circumferential order n [1/m].

    eps_rr = du_r/dr, eps_tt = (u_r + i n u_t) / r, gamma_rt = i n u_r / r + du_t/dr - u_t / r. They are exact around
    the circumference, and quadratic through the three nearest rings along the radius.

    Raises
    ------
    ValueError
        If the radius is not on the flat of the collar.
    """
    hat = sector.hat
    flat = hat.radius + hat.fillet
    if not flat <= radius <= hat.clamp_radius:
        raise ValueError(f"gauge radius {radius} m must be on the collar, from {flat} m to {hat.clamp_radius} m")
    on_back = (sector.layer(INNER)) & (sector.nodes[:, 2] < 0) & (sector.nodes[:, 0] >= flat - 1e-9)
    back = np.flatnonzero(on_back)
    rings = back[np.argsort(np.abs(sector.nodes[back, 0] - radius))[:3]]
    value, slope = np.linalg.inv(np.vander(sector.nodes[rings, 0] - radius, 3, increasing=True))[:2]
    n = orders(sector.count)
    u_r, u_t = 3 * rings, 3 * rings + 1
    rows = np.zeros((len(n), 3, 3 * len(sector.nodes)), complex)
    rows[:, 0, u_r] = slope
    rows[:, 1, u_r] = value / radius
    rows[:, 1, u_t] = 1j * n[:, None] * value / radius
    rows[:, 2, u_r] = 1j * n[:, None] * value / radius
    rows[:, 2, u_t] = slope - value / radius
    return rows


def bridges(gauges: GaugeSet, strain: Complex[np.ndarray, "order 3 load"]) -> Complex[np.ndarray, "order 5 load"]:
    """Bridge equation: signals [mV/V] per circumferential order from the strains at angle 0.

    A pair of grids at +-45 degrees, turned by the error delta, has the difference of strains
    cos(2 delta) gamma_rt - sin(2 delta) (eps_rr - eps_tt). A bridge of a gauge factor k with 2 or 4 active arms gives
    s = 1000 k / 4 (arms / 2) gain times this [mV/V], averaged over the positions beta of its pairs by exp(i n beta).

    Parameters
    ----------
    gauges : GaugeSet
    strain : array (order, 3, load)
        eps_rr, eps_tt, gamma_rt [-], or per unit of the load.

    Returns
    -------
    array (order, 5, load)
        Without the zeros, which :func:`offsets` gives.
    """
    n = np.arange(len(strain))
    signals = np.empty((len(strain), len(SENSORS), strain.shape[2]), complex)
    for s, angles in enumerate(LAYOUT):
        skew = 2 * gauges.grid_angle[s]
        pair = np.cos(skew) * strain[:, 2] - np.sin(skew) * (strain[:, 0] - strain[:, 1])
        turn = np.exp(1j * np.outer(n, angles + gauges.position[s])).mean(axis=1)
        millivolt = 1e3 * gauges.gauge_factor / 4 * (gauges.active_arms[s] // 2) * gauges.gain[s]
        signals[:, s] = millivolt * turn[:, None] * pair
    return signals


def waves(number: int) -> Complex[np.ndarray, "5 1"]:
    """Mean over the grids of each bridge of a field of ``number`` waves, exp(i number beta), around the collar."""
    return np.array([[np.exp(1j * number * angles).mean()] for angles in LAYOUT])


def offsets(gauges: GaugeSet) -> Float[np.ndarray, "5"]:
    """Zero of each bridge [mV/V]."""
    return np.array(gauges.offset)
