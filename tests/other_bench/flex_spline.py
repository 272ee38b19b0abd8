"""Strains at the gauges over the angle of the wave generator and the torque.

The band lies on the elastic ring of the wave generator's bearing, which holds it in both directions: it is not lifted
off. So each state is one system of linear equations; a crack adds two unknowns, by how much it hinges and opens.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Complex, Float

from other_bench.circle import ORDER, POINTS, PSI, STEP, THETA, X, circulant, coefficients, wrapped
from other_bench.engagement import tooth_forces, wave_generator
from other_bench.shell import solved
from other_bench.specimen import Specimen

# Stiffness of bearing and balls under a lobe, per rad [N/m/rad], and its share between the lobes: estimates.
LOBE, WAIST = 1.8e8, 0.35
RING = LOBE * (WAIST + (1 - WAIST) * np.cos(X) ** 2)
# Width of a cracked root: three of 200 tooth pitches [rad], and spread of its hinge over it.
ROOT_WIDTH, SPREAD = np.radians(5.4), 0.4


class Strains(NamedTuple):
    """On the collar's back at the gauges' radius, as Fourier coefficients around the flex spline.

    Attributes
    ----------
    shear, diff : array (psi, torque, order)
        Shear strain, and radial less circumferential strain.
    """

    shear: Complex[np.ndarray, "psi torque x"]
    diff: Complex[np.ndarray, "psi torque x"]


def strains(unit: Specimen, warp: complex = 0j) -> Strains:
    """Strains of a unit, the clamped edge of its collar warped by Re(warp exp(-i theta)) [m]."""
    C = solved(unit.hat).C
    wg = wave_generator(unit)
    radial, tangential = tooth_forces(unit, wg)
    edge = np.broadcast_to((warp * np.exp(-1j * THETA)).real[:, None], radial.shape)
    acting = {"radial": RING * wg[:, None] + radial, "tangential": tangential, "warp": edge}
    w, hinge = _deflected(unit, acting)
    acting["radial"] = acting["radial"] - RING * w
    spread = _crack(unit)[:, None]
    acting |= {"bend": hinge[..., :1] * spread, "stretch": hinge[..., 1:] * spread}
    # From orders around the wave generator to those around the flex spline.
    turn = np.exp(-1j * ORDER * PSI[:, None, None])
    lines = {case: turn * coefficients(load) for case, load in acting.items()}
    return Strains(*(sum(C[row, case] * load for case, load in lines.items()) for row in ("shear", "diff")))


def _deflected(
    unit: Specimen, acting: dict[str, Float[np.ndarray, "psi torque x"]]
) -> tuple[Float[np.ndarray, "psi torque x"], Float[np.ndarray, "psi torque 2"]]:
    """Radial displacement of the band [m]; hinge [rad] and opening [m] of the crack.

    Parameters
    ----------
    unit : Specimen
    acting : dict
        All that acts but a crack, the radial load as if the band stayed round.
    """
    shell = solved(unit.hat)
    g = _crack(unit)
    # The crack yields to the mean moment and force over it, which themselves fall as it does.
    over = g * STEP * unit.hat.R
    lost = unit.root.share / (1 - unit.root.share)
    give = ROOT_WIDTH * unit.hat.R * lost / np.array([shell.D_bend, shell.D_stretch])
    C = {key: circulant(c) for key, c in shell.C.items()}
    at_crack = {case: np.stack([over @ C[row, case] for row in "MN"], axis=1) for case in (*acting, "bend", "stretch")}
    of_crack = np.stack([g @ C["w", case].T for case in ("bend", "stretch")], axis=-1)
    of_itself = np.stack([(at_crack[case] * g[:, None]).sum(axis=-1) for case in ("bend", "stretch")], axis=-1)

    A = np.zeros((len(PSI), POINTS + 2, POINTS + 2))
    A[:, :POINTS, :POINTS] = np.eye(POINTS) + C["w", "radial"] * RING
    A[:, :POINTS, POINTS:] = -of_crack
    A[:, POINTS:, :POINTS] = give[:, None] * at_crack["radial"] * RING
    A[:, POINTS:, POINTS:] = np.eye(2) - give[:, None] * of_itself
    of_band = sum(load @ C["w", case].T for case, load in acting.items())
    of_hinge = give * sum(load @ at_crack[case].transpose(0, 2, 1) for case, load in acting.items())
    solution = np.linalg.solve(A, np.concatenate([of_band, of_hinge], axis=-1).transpose(0, 2, 1)).transpose(0, 2, 1)
    return solution[..., :POINTS], solution[..., POINTS:]


def _crack(unit: Specimen) -> Float[np.ndarray, "psi x"]:
    """Where the crack hinges: a density around the flex spline of integral 1 [1/m]."""
    g = np.exp(-0.5 * (wrapped(THETA - unit.root.angle) / (SPREAD * ROOT_WIDTH)) ** 2)
    return g / (g.sum(axis=-1, keepdims=True) * STEP * unit.hat.R)
