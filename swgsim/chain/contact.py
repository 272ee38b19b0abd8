"""Contact of a wave generator that only presses: where it does not touch the sleeve, the sleeve takes its own shape.

In the paper's chain the sleeve follows the wave generator all around (Fig. 5). A real one touches it around the lobes,
and there is a gap near the minor axis. With the radial displacement u of the sleeve, the displacement d that the wave
generator asks for, and its force q on a sector,

    u = C q + D F                                          (F: tooth forces; C, D: compliance of the flex spline)
    q >= 0 and u >= d - q / k, one of them with equality   (k: bearing of the wave generator)

C and D act on each circumferential order alone; over the width of the band the displacement is even. The set of points
that touch is found by iteration: a point with a negative force is released, and one that would penetrate is added. The
compliance is that of a sound sleeve, and the teeth share the load by what the wave generator asks for.
"""

from math import pi

import numpy as np
from jaxtyping import Bool, Complex, Float

from swgsim.flexspline.flexspline import TEETH, WAVE_GENERATOR, FlexSpline
from swgsim.flexspline.structure_factors import StructureFactors

# Radial stiffness of the wave generator's bearing per length of the circumference [N/m^2]: some 25 balls of 1e7 N/m on
# a radius of 21 mm; an estimate.
BEARING_STIFFNESS = 2e9
# Points around the circumference at which contact is decided; even.
POINTS = 96
# Iterations at most; between two sets of points that follow one another, the force differs at the ends of the contact.
MOST_ITERATIONS = 20


def pressed(
    flex: FlexSpline,
    factors: StructureFactors,
    asked: Complex[np.ndarray, "psi order"],
    forces: Complex[np.ndarray, "psi order"],
    psi: Float[np.ndarray, " psi"],
    every: int = 1,
) -> Complex[np.ndarray, "psi order"]:
    """Radial displacement of the sleeve under a wave generator that only presses, as circumferential orders [m].

    Parameters
    ----------
    flex : FlexSpline
    factors : StructureFactors
        Of which those on the compliance count.
    asked : array (psi, order)
        Displacement that the wave generator asks for, its interference included [m].
    forces : array (psi, order)
        Tooth forces on the sectors [N].
    psi : array (psi,)
        Angles of the wave generator [rad].
    every : int
        Contact is decided at the first of so many angles, which must then be even over a revolution. The force turns
        with the wave generator, so between them it is interpolated in a frame that turns along.
    """
    count = min(POINTS // 2, flex.sector.count // 2) + 1
    compliance = factors.softened(flex.compliance[:count])
    by_teeth = compliance[:, TEETH] * forces[:, :count]
    turn = np.exp(1j * np.outer(psi, np.arange(count)))
    short = ((asked[:, :count] - by_teeth) * turn)[::every]
    demand = POINTS * np.fft.irfft(short, POINTS, axis=1)
    of_bearing = flex.sector.count / (BEARING_STIFFNESS * 2 * pi * flex.sector.hat.radius)
    force = _contact_force(compliance[:, WAVE_GENERATOR].real, of_bearing, demand)
    orders = np.fft.rfft(force, axis=1)[:, :count] / POINTS
    displacement = asked.copy()
    around = _interpolated(orders, every) * np.conj(turn)
    displacement[:, :count] = compliance[:, WAVE_GENERATOR] * around + by_teeth
    return displacement


def _contact_force(
    compliance: Float[np.ndarray, " order"], of_bearing: float, demand: Float[np.ndarray, "psi point"]
) -> Float[np.ndarray, "psi point"]:
    """Force per sector [N] at points around the circumference that are `demand` [m] short of the wave generator."""
    lag = np.arange(POINTS)
    between = np.fft.irfft(compliance, POINTS)[(lag[:, None] - lag) % POINTS]
    touching, force = demand > 0, np.zeros_like(demand)
    for _ in range(MOST_ITERATIONS):
        force = _force_where(touching, between + of_bearing * np.eye(POINTS), demand)
        now = demand - force @ between > 0
        if np.array_equal(now, touching):
            break
        touching = now
    return force


def _force_where(
    touching: Bool[np.ndarray, "psi point"],
    compliance: Float[np.ndarray, "point point"],
    demand: Float[np.ndarray, "psi point"],
) -> Float[np.ndarray, "psi point"]:
    """Force that brings the points that touch to the wave generator, 0 elsewhere."""
    both = touching[:, :, None] & touching[:, None, :]
    matrix = np.where(both, compliance, np.diag(np.diag(compliance)))
    return np.linalg.solve(matrix, np.where(touching, demand, 0.0)[..., None])[..., 0]


def _interpolated(values: Complex[np.ndarray, "psi order"], times: int) -> Complex[np.ndarray, "angle order"]:
    """Periodic values at so many times as many angles, by their Fourier series."""
    if times == 1:
        return values
    lines, half = np.fft.fft(values, axis=0), len(values) // 2
    wide = np.zeros((times * len(values), values.shape[1]), complex)
    wide[:half], wide[-half:] = lines[:half], lines[half:]
    return np.fft.ifft(wide, axis=0) * times
