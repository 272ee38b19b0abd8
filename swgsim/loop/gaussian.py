"""A residual with errors of known kinds: independent ones, and ones that move many numbers together.

The covariance of a residual is diag(variance) + G G^T. The columns of G are errors that move all lines of a recording
at once (load, trigger, zero of a bridge) and directions in which declared parameters may lie, each scaled to one
standard deviation. A residual, a signature and a prediction are all weighed with its inverse square root, so that what
a declared parameter can absorb costs nothing and counts for nothing.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.singular import svd


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
    def _scaled(self) -> tuple[Float[np.ndarray, "row rank"], Float[np.ndarray, " rank"]]:
        """Left singular vectors and values of G in units of the independent errors."""
        U, s, _ = svd(self.G / np.sqrt(self.variance)[:, None])
        return U, s

    def whiten(self, X: np.ndarray) -> np.ndarray:
        """W X with W covariance W' = 1, for an array (row,) or (row, column)."""
        return self._shrunken(X / self._deviation(X))

    def transposed(self, X: np.ndarray) -> np.ndarray:
        """W' X, where W is what :meth:`whiten` multiplies by; it is not symmetric."""
        return self._shrunken(X) / self._deviation(X)

    def _deviation(self, X: np.ndarray) -> np.ndarray:
        """Standard deviation of the independent errors, to be combined with X."""
        return np.sqrt(self.variance).reshape(-1, *[1] * (X.ndim - 1))

    def _shrunken(self, X: np.ndarray) -> np.ndarray:
        """X with the directions of the common errors made as small as their variance is large."""
        U, s = self._scaled
        shrink = (1 / np.sqrt(1 + s**2) - 1).reshape(-1, *[1] * (X.ndim - 1))
        return X + U @ (shrink * (U.T @ X))

    def with_columns(self, G: Float[np.ndarray, "row more"]) -> "Covariance":
        """The covariance with further common errors."""
        return Covariance(self.variance, np.hstack([self.G, G]))

    def log_likelihood(self, r: Float[np.ndarray, " row"]) -> float:
        """Of a residual, without the constant."""
        s = self._scaled[1]
        white = self.whiten(r)
        return -0.5 * float(white @ white + np.log1p(s**2).sum() + np.log(self.variance).sum())

    def rows(self, chosen: np.ndarray) -> "Covariance":
        """The covariance of some of the rows."""
        return Covariance(self.variance[chosen], self.G[chosen])

    def left_out(self, r: Float[np.ndarray, " row"], block: np.ndarray) -> "Expected":
        """The rows of a block (a mask) as all the other rows predict them."""
        others = self.rows(~block)
        weighted = others.G / others.variance[:, None]
        precision = np.eye(self.G.shape[1]) + weighted.T @ others.G
        mean = np.linalg.solve(precision, weighted.T @ r[~block])
        # Columns that the other rows leave open, one standard deviation each.
        root = np.linalg.inv(np.linalg.cholesky(precision)).T
        here = Covariance(self.variance[block], self.G[block] @ root)
        missed = r[block] - self.G[block] @ mean
        return Expected(missed, here.log_likelihood(missed), mean)


class Expected(NamedTuple):
    """How rows were missed by what the others expected of them, the log-likelihood of that, and the common errors that
    the others tell, in standard deviations.
    """

    missed: Float[np.ndarray, " block"]
    log_likelihood: float
    common: Float[np.ndarray, " column"]
