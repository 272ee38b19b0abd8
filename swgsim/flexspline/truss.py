"""A space truss: nodes, elastic bars, stiffness matrix, solution; without any property of a gear."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import sparse
from scipy.sparse.linalg import splu


@dataclass(frozen=True)
class Truss:
    """Pin-jointed nodes connected by elastic bars.

    Attributes
    ----------
    nodes : array (node, 3)
        Cartesian positions [m].
    bars : array (bar, 2)
        The two nodes of each bar.
    stiffness : array (bar,)
        Axial stiffness k_bar of each bar, E A / L [N/m].

    Raises
    ------
    ValueError
        If a bar has no length, a negative or non-finite stiffness, or a node that does not exist.
    """

    nodes: Float[np.ndarray, "node 3"]
    bars: Int[np.ndarray, "bar 2"]
    stiffness: Float[np.ndarray, " bar"]

    def __post_init__(self) -> None:
        if self.bars.min() < 0 or self.bars.max() >= len(self.nodes):
            raise ValueError(f"a bar names node {self.bars.max()}, but there are {len(self.nodes)} nodes")
        if not np.all(np.isfinite(self.stiffness)) or self.stiffness.min() < 0:
            worst = int(np.argmin(np.where(np.isfinite(self.stiffness), self.stiffness, -np.inf)))
            raise ValueError(f"stiffness of bar {worst} is {self.stiffness[worst]} N/m, must be finite and at least 0")
        lengths = np.linalg.norm(self.nodes[self.bars[:, 1]] - self.nodes[self.bars[:, 0]], axis=1)
        if lengths.min() <= 0:
            raise ValueError(f"bar {int(np.argmin(lengths))} has length 0: its two nodes coincide")

    @cached_property
    def elongation(self) -> sparse.csr_array:
        """Matrix (bar, 3 node) from nodal displacements to bar elongations [m/m]."""
        first, second = self.bars.T
        axis = self.nodes[second] - self.nodes[first]
        axis /= np.linalg.norm(axis, axis=1, keepdims=True)
        rows = np.repeat(np.arange(len(self.bars)), 6)
        columns = np.concatenate([3 * first[:, None] + np.arange(3), 3 * second[:, None] + np.arange(3)], axis=1)
        values = np.concatenate([-axis, axis], axis=1)
        shape = (len(self.bars), 3 * len(self.nodes))
        return sparse.csr_array((values.ravel(), (rows, columns.ravel())), shape=shape)

    @cached_property
    def matrix(self) -> sparse.csc_array:
        """Stiffness matrix K = sum of k_bar d d^T over the bars, with elongations d, (3 node, 3 node) [N/m]."""
        return (self.elongation.T @ (sparse.diags_array(self.stiffness) @ self.elongation)).tocsc()


class Factorised:
    """A stiffness matrix with some displacements prescribed, factorised once for many right-hand sides.

    Parameters
    ----------
    matrix : sparse array (dof, dof)
        Stiffness [N/m].
    prescribed : boolean array (dof,)
        Which displacements are given; all others are free.
    """

    def __init__(self, matrix: sparse.csc_array, prescribed: Bool[np.ndarray, " dof"]) -> None:
        self.free, self.given = np.flatnonzero(~prescribed), np.flatnonzero(prescribed)
        self.coupling = matrix[self.free][:, self.given]
        self.factor = splu(matrix[self.free][:, self.free].tocsc())

    def solve(
        self, forces: Float[np.ndarray, " dof"], displacements: Float[np.ndarray, " dof"]
    ) -> Float[np.ndarray, " dof"]:
        """Displacements [m] under forces [N] on the free and displacements [m] of the given degrees of freedom."""
        u = displacements.copy()
        u[self.free] = self.factor.solve(forces[self.free] - self.coupling @ displacements[self.given])
        return u
