"""What the five bridges read, from maps over the angle of the wave generator and the torque."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Complex, Float

from other_bench.circle import ORDER, PSI
from other_bench.engagement import TORQUES
from other_bench.flex_spline import Strains, strains
from other_bench.motion import Motion
from other_bench.shell import solved
from other_bench.specimen import Specimen

# Places of s1 to s4, and of the four half bridges of s0 [rad].
BETA, BETA_S0 = np.radians([0.0, 90.0, 180.0, 270.0]), np.radians([45.0, 135.0, 225.0, 315.0])
# A half bridge of gauge factor 2 reads a quarter of it times the shear strain [mV/V]; s0, a full one, twice that.
MV_PER_STRAIN = 1e3 * 2.0 / 4
ARMS = np.array([2, 1, 1, 1, 1])
# Lines and powers of the torque, over 70 N m, that a map is made of; of a healthy unit that leaves out 2 nV/V, of a
# cracked one 40 at most, where noise has an rms of 120 to 150.
HIGHEST, POWERS, FULL = 12, 5, 70.0
# Tilting stiffness of the output bearing, 45 N m per arc minute (physics.md section 2.2) [N m/rad].
TILTING = 45 * 60 * 180 / np.pi
# Gauges that see the case breathe.
BREATHING = np.array([0, 1, 0, -1, 0])


class Maps(NamedTuple):
    """Of a unit.

    Attributes
    ----------
    own : array (gauge, power, order)
        Coefficients of the powers of the torque and of the orders of the wave generator [mV/V].
    tilt : array (2, gauge, power, order)
        What the unit's tilting moment adds when it points to 0 and to 90 degrees.
    drag : array (gauge,)
        What 1 N m that the wave generator takes is seen as [mV/V].
    """

    own: Complex[np.ndarray, "gauge power order"]
    tilt: Complex[np.ndarray, "2 gauge power order"]
    drag: Float[np.ndarray, " gauge"]


def maps_of(unit: Specimen) -> Maps:
    """Maps of a unit."""
    own = _map(unit, strains(unit))
    # The output bearing tilts, and with it the edge at which the collar is clamped.
    warp = abs(unit.moment) / TILTING * unit.hat.clamp
    tilt = np.array([_map(unit, strains(unit, warp * direction)) - own for direction in (1, 1j)])
    per_torque = -1 / (2 * np.pi * unit.hat.R) * solved(unit.hat).C["shear", "tangential"][0].real
    return Maps(own, tilt, MV_PER_STRAIN * per_torque * ARMS)


def signals(unit: Specimen, maps: Maps, motion: Motion) -> Float[np.ndarray, "gauge time"]:
    """Ideal signals of s0 to s4 [mV/V]."""
    s = evaluated(maps.own, motion.phi, motion.T_out)
    # The collar carries what the teeth give less what the wave generator takes.
    s -= maps.drag[:, None] * motion.T_wg
    if unit.moment:
        direction = motion.turned + np.angle(unit.moment)
        along, across = (evaluated(tilt, motion.phi, motion.T_out) for tilt in maps.tilt)
        s += along * np.cos(direction) + across * np.sin(direction)
    breathing = (motion.T_out / FULL) ** 2 * (unit.breathing * np.exp(4j * motion.phi)).real
    return s + BREATHING[:, None] * breathing


def evaluated(
    maps: Complex[np.ndarray, "gauge power order"], phi: Float[np.ndarray, " time"], T: Float[np.ndarray, " time"]
) -> Float[np.ndarray, "gauge time"]:
    """A map at angles of the wave generator [rad] and torques [N m]."""
    turns = np.exp(1j * np.outer(np.arange(HIGHEST + 1), phi))
    turns[1:] *= 2
    return sum((c @ turns).real * (T / FULL) ** power for power, c in enumerate(np.moveaxis(maps, 1, 0)))


def _map(unit: Specimen, e: Strains) -> Complex[np.ndarray, "gauge power order"]:
    """Map of strains at the gauges where they sit."""
    s0 = sum(_half_bridge(e, beta, unit.grid_angle[0]) for beta in BETA_S0 + unit.arms) / len(BETA_S0)
    places = zip(BETA + unit.position, unit.grid_angle[1:], strict=True)
    s = ARMS[:, None, None] * np.array([s0, *(_half_bridge(e, beta, turned) for beta, turned in places)])
    lines = np.fft.fft(s, axis=1)[:, : HIGHEST + 1] / len(PSI)
    powers = np.vander(TORQUES / FULL, POWERS, increasing=True)
    return np.linalg.pinv(powers) @ lines.transpose(0, 2, 1)


def _half_bridge(e: Strains, beta: float, grid_angle: float) -> Float[np.ndarray, "psi torque"]:
    """Signal of two grids at 45 degrees to the meridian, at beta, turned by a small angle [mV/V]."""
    turn = np.exp(1j * ORDER * beta)
    shear = np.cos(2 * grid_angle) * (e.shear @ turn) - np.sin(2 * grid_angle) * (e.diff @ turn)
    return MV_PER_STRAIN * shear.real
