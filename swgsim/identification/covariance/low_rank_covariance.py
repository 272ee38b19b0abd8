"""A residual with errors of known kinds: those of single recordings, and ones that recordings share.

The covariance of a residual is A + G G^T. A holds the errors of every recording by itself, and maybe some of the
others. The columns of G are errors of whole sessions (zero of a bridge, index of the angle) and directions in which
declared parameters may lie, each scaled to one standard deviation. A residual, a signature and a prediction are all
weighted by the inverse of the covariance. So what a declared parameter can absorb costs nothing and counts for nothing.

With Sigma for the covariance, two operations do this. ``whiten`` multiplies by a square root of Sigma^-1: products of
whitened vectors are weighted sums, and a whitened residual has independent numbers of variance 1. ``weigh`` multiplies
by Sigma^-1 itself: a product of a vector with a weighed residual is the same weighted sum.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float
from scipy.linalg import cho_solve, cholesky, solve_triangular

from swgsim.identification.covariance.recording_covariance import RecordingCovariance

# Common errors are left out where they make a variance larger than noise makes it by no more than this share.
HIDDEN = 1e-4


@dataclass(frozen=True, eq=False)
class Covariance:
    """A + G G^T, where A may be such a sum too: what is known of A serves all that are built on it.

    Attributes
    ----------
    base : RecordingCovariance or Covariance
        A: errors of single recordings, and maybe some common ones.
    G : array (row, column)
        Common errors, or more of them, one standard deviation each.
    """

    base: "RecordingCovariance | Covariance"
    G: Float[np.ndarray, "row column"]

    @property
    def alone(self) -> RecordingCovariance:
        """Errors of single recordings."""
        return self.base if isinstance(self.base, RecordingCovariance) else self.base.alone

    @property
    def columns(self) -> Float[np.ndarray, "row column"]:
        """All common errors, one standard deviation each."""
        return self.G if isinstance(self.base, RecordingCovariance) else np.hstack([self.base.columns, self.G])

    @property
    def variance(self) -> Float[np.ndarray, " row"]:
        """Of the independent errors."""
        return self.alone.variance.ravel()

    @cached_property
    def _weighed(self) -> Float[np.ndarray, "row column"]:
        """A^-1 G."""
        return self.base.weigh(self.G)

    @cached_property
    def _L(self) -> Float[np.ndarray, "column column"]:
        """Lower triangular, L L' = 1 + G' A^-1 G: several times smaller than G."""
        return cholesky(np.eye(self.G.shape[1]) + self.G.T @ self._weighed, lower=True)

    @cached_property
    def _common_precision(self) -> Float[np.ndarray, "column row"]:
        """L^-1 G' A^-1, of which blocks of rows take their parts."""
        return solve_triangular(self._L, self._weighed.T, lower=True, check_finite=False)

    @cached_property
    def _one_plus_Lt(self) -> Float[np.ndarray, "column column"]:
        """1 + L': with L it makes K of :meth:`whiten`, and so a square root of the inverse of the covariance."""
        return np.eye(len(self._L)) + self._L.T

    def whiten(self, X: np.ndarray) -> np.ndarray:
        """W X with W covariance W' = 1, a square root of its inverse, for an array (row,) or (row, column).

        W is fast to apply, but it mixes rows: its numbers belong to no row.
        W = A^-1/2 (1 - G K G' A^-1) with K = (L (1 + L'))^-1, as W' W = (A + G G')^-1 then.
        """
        along = solve_triangular(self._L, self._weighed.T @ X, lower=True)
        return self.base.whiten(X - self.G @ solve_triangular(self._one_plus_Lt, along))

    def whiten_in_place(self, r: Float[np.ndarray, " row"]) -> Float[np.ndarray, " row"]:
        """W r with W covariance W' = 1, where each number of W r can still be read as that of its row.

        The rows are divided by the standard deviations of the independent errors first. W is then the symmetric square
        root, which changes the rows as little as any can. It is slower than :meth:`whiten`.
        """
        deviation = np.sqrt(self.variance)
        scaled = np.hstack([self.alone.dense, self.columns]) / deviation[:, None]
        eigenvalues, V = np.linalg.eigh(scaled.T @ scaled)
        root = np.sqrt(1 + np.maximum(eigenvalues, 0))  # what rounding makes of them shrinks nothing
        return r / deviation - scaled @ (V @ (V.T @ (scaled.T @ (r / deviation)) / (root * (1 + root))))

    def weigh(self, X: np.ndarray) -> np.ndarray:
        """P X with P = (A + G G')^-1, the inverse of the covariance, for an array (row,) or (row, column)."""
        return self.base.weigh(X) - self._weighed @ self._mean(X)

    def precision(self, block: Bool[np.ndarray, " row"]) -> Float[np.ndarray, "block block"]:
        """The block of P of some of the rows: of their distribution where all the others are known."""
        common = self._common_precision[:, block]
        return self.base.precision(block) - common.T @ common

    def with_columns(self, G: Float[np.ndarray, "row more"]) -> "Covariance":
        """The covariance with further common errors."""
        return Covariance(self, G) if G.shape[1] else self

    @property
    def log_determinant(self) -> float:
        """Of the covariance."""
        return self.base.log_determinant + 2 * float(np.log(np.diag(self._L)).sum())

    def log_likelihood(self, r: Float[np.ndarray, " row"]) -> float:
        """Of a residual, without the constant."""
        white = self.whiten(r)
        return -0.5 * (float(white @ white) + self.log_determinant)

    def drawn(self, rng: np.random.Generator, draws: int) -> Float[np.ndarray, "row draw"]:
        """Residuals with this covariance."""
        recordings, _, kinds = self.alone.C.shape
        made = self.alone.made(rng.standard_normal((recordings * kinds, draws)))
        made += self.columns @ rng.standard_normal((self.columns.shape[1], draws))
        return made + np.sqrt(self.variance)[:, None] * rng.standard_normal(made.shape)

    def common_mean(self, X: np.ndarray) -> np.ndarray:
        """Posterior mean of the common errors (column,), in standard deviations, given a residual (row,) or several."""
        mean = self._mean(X)
        return (
            mean
            if isinstance(self.base, RecordingCovariance)
            else np.concatenate([self.base.common_mean(X - self.G @ mean), mean])
        )

    def _mean(self, X: np.ndarray) -> np.ndarray:
        """Posterior mean of the errors in G alone, in standard deviations. The errors of A are unknown too."""
        return cho_solve((self._L, True), self._weighed.T @ X)

    def recordings(self, chosen: Bool[np.ndarray, " recording"]) -> "Covariance":
        """The covariance of some of the recordings."""
        return Covariance(self.base.recordings(chosen), self.G[np.repeat(chosen, self.alone.variance.shape[1])])

    def left_out(
        self, r: Float[np.ndarray, " row"], blocks: Sequence[Bool[np.ndarray, " row"]]
    ) -> list[Float[np.ndarray, " column"]]:
        """The common errors, in standard deviations, that the rows outside of each block tell.

        With the precision P of all rows, the others expect the rows b of a block (P_bb)^-1 (P r)_b away from r.
        """
        weighed = self.weigh(r)
        # One column for each block, since a product with many columns takes little more time than with one.
        expected = np.repeat(r[:, None], len(blocks), axis=1)
        for number, block in enumerate(blocks):
            L = cholesky(self.precision(block), lower=True)
            white = solve_triangular(L, weighed[block], lower=True)
            expected[block, number] -= solve_triangular(L, white, lower=True, trans=1)
        return list(self.common_mean(expected).T)


def as_squares(log_likelihood: float) -> float:
    """A gain of log-likelihood as a fall of a sum of squares: a log-likelihood is minus half of one."""
    return 2 * log_likelihood


def significant_columns(
    columns: Float[np.ndarray, "row column"], variance: Float[np.ndarray, " row"]
) -> Float[np.ndarray, "row fewer"]:
    """As few common errors as have the same covariance, within a small share of the noise's.

    Parameters
    ----------
    columns : array (row, column)
        Common errors, one standard deviation each.
    variance : array (row,)
        Of the noise.
    """
    scaled = columns / np.sqrt(variance)[:, None]
    share, V = np.linalg.eigh(scaled.T @ scaled)
    kept = share > HIDDEN
    return columns if kept.all() else columns @ V[:, kept]
