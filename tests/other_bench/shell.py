"""How the hat answers to what acts on its band and its edge, order by order: a linear thin shell of revolution."""

from functools import cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Complex, Float

from other_bench.circle import ORDERS, both_signs
from other_bench.frustum import Places, places, stiffness
from other_bench.hat import Hat

# Three points of Gauss and Legendre per element.
GAUSS, WEIGHTS = np.array([0.5 - np.sqrt(0.15), 0.5, 0.5 + np.sqrt(0.15)]), np.array([5, 8, 5]) / 18
# Radii within a gauge's grid, in thirds of it, at which it is read.
ACROSS_GRID = np.array([-1, 0, 1]) / 3
# What answers: mean radial displacement, hoop moment and hoop force of the band; at the gauges shear strain, and
# radial less circumferential strain.
ANSWERS = ("w", "M", "N", "shear", "diff")
# What acts: radial and circumferential force on the band [N/rad], curvature and strain imposed on it where it is
# cracked [1/m, -], and the clamped edge warped out of its plane [m].
CASES = ("radial", "tangential", "bend", "stretch", "warp")


class Shell(NamedTuple):
    """Compliances of a hat.

    Attributes
    ----------
    C : dict
        Each of ANSWERS to each of CASES: Fourier coefficients (x,) of the one over those of the other.
    D_bend, D_stretch : float
        Stiffness of the band in the hoop direction: moment per curvature [N m], force per strain [N/m].
    """

    C: dict[tuple[str, str], Complex[np.ndarray, " x"]]
    D_bend: float
    D_stretch: float


@cache
def solved(hat: Hat) -> Shell:
    """The shell of a hat; it takes half a second, so it is kept for the process only."""
    mesh = _meshed(hat)
    answers = np.array([_of_order(n, hat, mesh) for n in range(ORDERS + 1)])
    band = mesh.D[np.argmax(mesh.over_band > 0)]
    # A strain that is imposed bears no stress itself.
    answers[:, ANSWERS.index("M"), CASES.index("bend")] -= band[4, 4]
    answers[:, ANSWERS.index("N"), CASES.index("stretch")] -= band[1, 1]
    C = {(row, case): both_signs(answers[:, i, j]) for i, row in enumerate(ANSWERS) for j, case in enumerate(CASES)}
    return Shell(C, float(band[4, 4]), float(band[1, 1]))


class _Mesh(NamedTuple):
    """Integration points with their stiffness and length of meridian [m], of this what lies in the band, and the grid
    of a gauge.
    """

    points: Places
    D: Float[np.ndarray, "place 6 6"]
    meridian: Float[np.ndarray, " place"]
    over_band: Float[np.ndarray, " place"]
    grid: Places


def _meshed(hat: Hat) -> _Mesh:
    elements = len(hat.thickness)
    element = np.repeat(np.arange(elements), len(GAUSS))
    points = places(hat.z, hat.r, element, np.tile(GAUSS, elements))
    meridian = points.length * np.tile(WEIGHTS, elements)
    radii = hat.gauge_radius + hat.grid * ACROSS_GRID
    of_grid = np.searchsorted(hat.r[hat.sleeve_elements :], radii) - 1 + hat.sleeve_elements
    return _Mesh(
        points,
        stiffness(hat.E, hat.nu, hat.thickness)[element],
        meridian,
        np.where(hat.in_band[element], meridian, 0.0),
        places(hat.z, hat.r, of_grid, (radii - hat.r[of_grid]) / (hat.r[of_grid + 1] - hat.r[of_grid])),
    )


def _of_order(n: int, hat: Hat, mesh: _Mesh) -> Complex[np.ndarray, "answer case"]:
    """Answers of order n to unit coefficients of that order."""
    points = mesh.points
    dofs = 4 * len(hat.z)
    B = points.strains(n)
    DB = mesh.D @ B
    K = np.zeros((dofs, dofs), complex)
    energy = (mesh.meridian * points.r)[:, None, None] * (B.conj().transpose(0, 2, 1) @ DB)
    np.add.at(K, (points.dof[:, :, None], points.dof[:, None, :]), energy)

    def gathered(at: Places, rows: np.ndarray, weights: np.ndarray) -> Complex[np.ndarray, " dof"]:
        vector = np.zeros(dofs, complex)
        np.add.at(vector, at.dof, weights[:, None] * rows)
        return vector

    width = mesh.over_band.sum()
    share = mesh.over_band / width
    w, v, M, N = (gathered(points, rows, share) for rows in (points.w, points.v, DB[:, 4], DB[:, 1]))
    # A gauge averages over its grid; it sits on the collar's back, away from the sleeve.
    surface = mesh.grid.strains(n)
    surface = surface[:, :3] - hat.collar / 2 * surface[:, 3:]
    arc = np.sinc(n * hat.grid / hat.gauge_radius / (2 * np.pi)) / len(ACROSS_GRID) * np.ones(len(ACROSS_GRID))
    shear, diff = gathered(mesh.grid, surface[:, 2], arc), gathered(mesh.grid, surface[:, 0] - surface[:, 1], arc)

    # The edge is clamped, but for the last case, where its axial displacement is 1. An imposed strain acts by the
    # forces that are work-conjugate to its stress resultant (Maxwell and Betti).
    free, edge = slice(0, dofs - 4), dofs - 4
    acting = np.array([w, v, hat.R * width * M.conj(), hat.R * width * N.conj(), -K[:, edge]])
    moved = np.zeros((dofs, len(CASES)), complex)
    moved[free] = np.linalg.solve(K[free, free], acting[:, free].T)
    moved[edge, CASES.index("warp")] = 1.0
    return np.array([w, M, N, shear, diff]) @ moved
