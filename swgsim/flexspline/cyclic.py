"""Linear elasticity of a structure that repeats around the circumference, solved per circumferential order.

The stiffness matrix of a truss of S equal sectors is block circulant in cylindrical components, so the discrete
Fourier transform over the sectors splits it into S / 2 + 1 small Hermitian systems: the exact solution of the whole
truss at a fraction of one factorisation.
"""

import numpy as np
from jaxtyping import Bool, Complex, Float, Int
from scipy import linalg

from swgsim.flexspline.silk_hat import Sector


def orders(count: int) -> Int[np.ndarray, " order"]:
    """The circumferential orders 0 .. S/2 of real fields on S sectors."""
    return np.arange(count // 2 + 1)


def order_weights(count: int) -> Float[np.ndarray, " order"]:
    """How often each order counts in a real field: the mean and order S/2 once, all others twice."""
    return np.where((orders(count) == 0) | (orders(count) == count // 2), 1.0, 2.0)


def bar_axes(sector: Sector) -> tuple[np.ndarray, np.ndarray]:
    """Unit vector of each bar of sector 0 in the cylindrical frames of its first and of its second node."""
    first, second, ahead = sector.bars.T
    start, end = sector.positions(0)[first], sector.positions(0)[second]
    following = sector.positions(1)[second]
    end = np.where(ahead[:, None] == 1, following, end)
    axis = (end - start) / np.linalg.norm(end - start, axis=1, keepdims=True)
    cosine, sine = np.cos(sector.pitch * ahead), np.sin(sector.pitch * ahead)
    turned = np.stack([cosine * axis[:, 0] + sine * axis[:, 1], cosine * axis[:, 1] - sine * axis[:, 0], axis[:, 2]], 1)
    return axis, turned


def stiffness_blocks(sector: Sector) -> tuple[Float[np.ndarray, "dof dof"], Float[np.ndarray, "dof dof"]]:
    """Coupling of a sector with itself and with the next one [N/m], cylindrical components."""
    here, following = bar_axes(sector)
    dof = 3 * len(sector.nodes)
    own, ahead = np.zeros((dof, dof)), np.zeros((dof, dof))
    for (first, second, step), k, d, e in zip(sector.bars, sector.stiffness, here, following, strict=True):
        a, b = slice(3 * first, 3 * first + 3), slice(3 * second, 3 * second + 3)
        own[a, a] += k * np.outer(d, d)
        own[b, b] += k * np.outer(e, e)
        if step:
            ahead[a, b] -= k * np.outer(d, e)
        else:
            own[a, b] -= k * np.outer(d, e)
            own[b, a] -= k * np.outer(e, d)
    return own, ahead


def solve(
    sector: Sector,
    prescribed: Bool[np.ndarray, " dof"],
    forces: Float[np.ndarray, "dof load"],
    displacements: Float[np.ndarray, "dof load"],
) -> Complex[np.ndarray, "order dof load"]:
    """Displacements [m] under load patterns that go around as exp(i n theta), for all orders n.

    Parameters
    ----------
    sector : Sector
    prescribed : boolean array (dof,)
        Degrees of freedom of one sector (3 per node: radial, circumferential, axial) that are given.
    forces : array (dof, load)
        Amplitudes of the nodal forces [N], the same for every order; those on given displacements have no effect.
    displacements : array (dof, load)
        Amplitudes of the prescribed displacements [m], the same for every order.
    """
    own, ahead = stiffness_blocks(sector)
    free, given = np.flatnonzero(~prescribed), np.flatnonzero(prescribed)
    # The sector is its own mirror image, so the matrices are real once u_theta is counted in quadrature; a load with
    # radial and circumferential parts then has a real and an imaginary part.
    turn = np.tile([1, 1j, 1], len(sector.nodes))
    loads, moves = np.conj(turn)[:, None] * forces, np.conj(turn)[:, None] * displacements
    fields = np.empty((sector.count // 2 + 1, *forces.shape), complex)
    for n in orders(sector.count):
        phase = np.exp(1j * sector.pitch * n)
        matrix = (np.conj(turn)[:, None] * (own + phase * ahead + np.conj(phase) * ahead.T) * turn).real
        right = loads[free] - matrix[np.ix_(free, given)] @ moves[given]
        inside = linalg.solve(matrix[np.ix_(free, free)], np.concatenate([right.real, right.imag], 1), assume_a="pos")
        fields[n, free] = inside[:, : right.shape[1]] + 1j * inside[:, right.shape[1] :]
        fields[n, given] = moves[given]
    return turn[:, None] * fields
