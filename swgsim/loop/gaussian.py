"""A residual with errors of known kinds: independent ones, and ones that move many numbers together.

The covariance of a residual is diag(variance) + G G^T. The columns of G are errors that move all lines of a recording
at once (load, trigger, zero of a bridge) and directions in which declared parameters may lie, each scaled to one
standard deviation. A residual, a signature and a prediction are all weighed with its inverse square root, so that what
a declared parameter can absorb costs nothing and counts for nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float
from scipy.linalg import cho_solve, cholesky, solve_triangular


@dataclass(frozen=True, eq=False)
class Covariance:
    """diag(variance) + G G^T.

    Attributes
    ----------
    variance : array (row,)
        Of the independent errors.
    G : array (row, column)
        Common errors, one standard deviation each.
    """

    variance: Float[np.ndarray, " row"]
    G: Float[np.ndarray, "row column"]

    @cached_property
    def _gram(self) -> Float[np.ndarray, "column column"]:
        """G' G in units of the independent errors."""
        scaled = self.G / np.sqrt(self.variance)[:, None]
        return scaled.T @ scaled

    @cached_property
    def _L(self) -> Float[np.ndarray, "column column"]:
        """Lower triangular, L L' = 1 + G' G in units of the independent errors: several times smaller than G."""
        return cholesky(np.eye(self.G.shape[1]) + self._gram, lower=True)

    @cached_property
    def _raised(self) -> Float[np.ndarray, "column column"]:
        """1 + L'."""
        return np.eye(len(self._L)) + self._L.T

    def whiten(self, X: np.ndarray) -> np.ndarray:
        """W X with W covariance W' = 1, for an array (row,) or (row, column).

        In units of the independent errors W = 1 - G K G' with K = (L (1 + L'))^-1, as W' W = (1 + G G')^-1 then.
        """
        scaled = X / self._deviation(X)
        along = solve_triangular(self._L, self._along(scaled), lower=True)
        return self._less(scaled, solve_triangular(self._raised, along))

    def whiten_in_place(self, r: Float[np.ndarray, " row"]) -> Float[np.ndarray, " row"]:
        """W r with W covariance W' = 1, where W is symmetric in units of the independent errors: as near to them as can
        be, so that each number still tells of its row. Slower than :meth:`whiten`.
        """
        eigenvalues, V = np.linalg.eigh(self._gram)
        root = np.sqrt(1 + np.maximum(eigenvalues, 0))  # what rounding makes of them shrinks nothing
        scaled = r / self._deviation(r)
        return self._less(scaled, V @ (V.T @ self._along(scaled) / (root * (1 + root))))

    def weigh(self, X: np.ndarray) -> np.ndarray:
        """P X with P the inverse of the covariance, for an array (row,) or (row, column)."""
        return self._less(X / self._deviation(X), self.told(X)) / self._deviation(X)

    def precision(self, block: Bool[np.ndarray, " row"]) -> Float[np.ndarray, "block block"]:
        """The block of P of some of the rows: of their distribution where all the others are known."""
        deviation = np.sqrt(self.variance[block])
        common = solve_triangular(self._L, (self.G[block] / deviation[:, None]).T, lower=True)
        return (np.eye(len(deviation)) - common.T @ common) / np.outer(deviation, deviation)

    def _deviation(self, X: np.ndarray) -> np.ndarray:
        """Standard deviation of the independent errors, to be combined with X."""
        return np.sqrt(self.variance).reshape(-1, *[1] * (X.ndim - 1))

    def _along(self, X: np.ndarray) -> np.ndarray:
        """G' X, in units of the independent errors."""
        return self.G.T @ (X / self._deviation(X))

    def _less(self, X: np.ndarray, along: np.ndarray) -> np.ndarray:
        """X less G times so much, in units of the independent errors."""
        return X - self.G @ along / self._deviation(X)

    def with_columns(self, G: Float[np.ndarray, "row more"]) -> "Covariance":
        """The covariance with further common errors."""
        return Covariance(self.variance, np.hstack([self.G, G])) if G.shape[1] else self

    def log_likelihood(self, r: Float[np.ndarray, " row"]) -> float:
        """Of a residual, without the constant."""
        white = self.whiten(r)
        return -0.5 * float(white @ white + 2 * np.log(np.diag(self._L)).sum() + np.log(self.variance).sum())

    def told(self, X: np.ndarray) -> np.ndarray:
        """The common errors (column,) that a residual (row,) tells, or each of several, in standard deviations."""
        return cho_solve((self._L, True), self._along(X / self._deviation(X)))

    def rows(self, chosen: np.ndarray) -> "Covariance":
        """The covariance of some of the rows."""
        return Covariance(self.variance[chosen], self.G[chosen])

    def left_out(self, r: Float[np.ndarray, " row"], blocks: Sequence[Bool[np.ndarray, " row"]]) -> list["Expected"]:
        """The rows of each block as all the other rows predict them.

        With the precision P of all rows these miss r by (P_bb)^-1 (P r)_b, with the covariance (P_bb)^-1.
        """
        weighed = self.weigh(r)
        return [self._left_out(r, weighed[block], block) for block in blocks]

    def _left_out(
        self, r: Float[np.ndarray, " row"], weighed: Float[np.ndarray, " block"], block: Bool[np.ndarray, " row"]
    ) -> "Expected":
        L = cholesky(self.precision(block), lower=True)
        white = solve_triangular(L, weighed, lower=True)
        missed = solve_triangular(L, white, lower=True, trans=1)
        expected = np.array(r, copy=True)
        expected[block] -= missed  # which tells no more than the others do
        return Expected(missed, float(np.log(np.diag(L)).sum() - 0.5 * white @ white), self.told(expected))


class Expected(NamedTuple):
    """How rows were missed by what the others expected of them, the log-likelihood of that, and the common errors that
    the others tell, in standard deviations.
    """

    missed: Float[np.ndarray, " block"]
    log_likelihood: float
    common: Float[np.ndarray, " column"]
