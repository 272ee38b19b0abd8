"""Densities of the observations of every class for one gear at one operating point."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import log, pi

import numpy as np
from jaxtyping import Float
from scipy.linalg import cholesky, solve_triangular
from scipy.special import logsumexp

from swgsim.oracle.cells import Cells
from swgsim.storage.labelled_signals import CLASSES


@dataclass(frozen=True)
class PointModel:
    """The distribution of the observations of every class, for one gear at one operating point.

    Healthy ones are Gaussian; those of a fault class are an even mixture of Gaussians, one for each of its cells.

    Attributes
    ----------
    mean : array (feature,)
        Mean of healthy observations.
    covariance : array (feature, feature)
    faults : mapping
        Cells of each fault class.
    """

    mean: Float[np.ndarray, " feature"]
    covariance: Float[np.ndarray, "feature feature"]
    faults: Mapping[str, Cells]

    def log_likelihood(self, x: Float[np.ndarray, "sample feature"]) -> Float[np.ndarray, "sample class"]:
        """Logarithm of the density of observations in each of CLASSES, minus infinity where there is no such class."""
        white = self._whiten(x - self.mean)
        constant = -np.log(np.diag(self._root)).sum() - 0.5 * len(self.mean) * log(2 * pi)
        found = np.full((len(x), len(CLASSES)), -np.inf)
        found[:, CLASSES.index("healthy")] = -0.5 * (white**2).sum(axis=1)
        for label, cells in self.faults.items():
            shift, spread = self._whiten(cells.shift), self._whiten(cells.spread)
            found[:, CLASSES.index(label)] = _log_mixture(white, Cells(shift, spread))
        return found + constant

    def log_posterior(self, x: Float[np.ndarray, "sample feature"]) -> Float[np.ndarray, "sample class"]:
        """Logarithm of the probability of each of CLASSES, all of them equally frequent."""
        likelihood = self.log_likelihood(x)
        return likelihood - logsumexp(likelihood, axis=1, keepdims=True)

    @cached_property
    def _root(self) -> Float[np.ndarray, "feature feature"]:
        """Lower Cholesky factor of the covariance."""
        return cholesky(self.covariance, lower=True)

    def _whiten(self, rows: Float[np.ndarray, "*row feature"]) -> Float[np.ndarray, "*row feature"]:
        """Rows in units in which the covariance is the identity."""
        flat = rows.reshape(-1, rows.shape[-1])
        return solve_triangular(self._root, flat.T, lower=True).T.reshape(rows.shape)


def _log_mixture(x: Float[np.ndarray, "sample feature"], cells: Cells) -> Float[np.ndarray, " sample"]:
    """Logarithm of an even mixture of Gaussians in white units, without the constant of the healthy class.

    Cell m has the covariance I + U' U of its spread U; with A = I + U U' its inverse is I - U' A^-1 U and its
    determinant that of A (Woodbury), so that systems have the size of the number of directions.
    """
    shift, spread = cells.shift, cells.spread
    count, directions, features = spread.shape
    root = np.linalg.cholesky(np.eye(directions) + spread @ np.swapaxes(spread, 1, 2))  # of A: (cell, direction, same)
    scaled = np.linalg.solve(root, spread)
    square = (x**2).sum(axis=1)[:, None] - 2 * x @ shift.T + (shift**2).sum(axis=1)  # (sample, cell)
    along = (x @ scaled.reshape(-1, features).T).reshape(len(x), count, directions)
    along -= np.einsum("mdf,mf->md", scaled, shift)
    half_determinant = np.log(np.diagonal(root, axis1=1, axis2=2)).sum(axis=1)
    return logsumexp(-0.5 * (square - (along**2).sum(axis=2)) - half_determinant, axis=1) - log(count)
