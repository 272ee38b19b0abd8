"""Bayes' rule: densities of the observations of every class, and what they say of class, severity and position."""

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
class Places:
    """A mixture of Gaussians over the cells of a class: where an observation lies.

    Attributes
    ----------
    weight : array (sample, cell)
        Probability of each cell.
    mean : array (sample, cell, direction)
        Within a cell, from its middle along severity and, where it matters, position. The unit is the standard
        deviation of an even distribution over the cell.
    deviation : array (cell, direction)
        Standard deviation, in the same unit.
    """

    weight: Float[np.ndarray, "sample cell"]
    mean: Float[np.ndarray, "sample cell direction"]
    deviation: Float[np.ndarray, "cell direction"]


@dataclass(frozen=True)
class PointModel:
    """The distribution of the observations of every class, for one gear at one operating point or at several together.

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
        for label, cells in self._white_faults.items():
            found[:, CLASSES.index(label)] = logsumexp(_within(white, cells)[0], axis=1)
        return found + constant

    def log_posterior(self, x: Float[np.ndarray, "sample feature"]) -> Float[np.ndarray, "sample class"]:
        """Logarithm of the probability of each of CLASSES, all of them equally frequent."""
        likelihood = self.log_likelihood(x)
        return likelihood - logsumexp(likelihood, axis=1, keepdims=True)

    def places(self, x: Float[np.ndarray, "sample feature"], label: str) -> Places:
        """Where within a fault class observations lie, if they are of that class."""
        cells = self._white_faults[label]
        log_density, along, root = _within(self._whiten(x - self.mean), cells)
        inverse = np.linalg.inv(root)  # L^-1 of A = L L': A^-1 is the posterior covariance along the directions
        weight = np.exp(log_density - logsumexp(log_density, axis=1, keepdims=True))
        mean = np.einsum("mji,smj->smi", inverse, along)
        return Places(weight, mean, np.sqrt((inverse**2).sum(axis=1)))

    @cached_property
    def _white_faults(self) -> dict[str, Cells]:
        """Cells in units in which the covariance is the identity."""
        return {
            label: Cells(self._whiten(cells.shift), self._whiten(cells.spread)) for label, cells in self.faults.items()
        }

    @cached_property
    def _root(self) -> Float[np.ndarray, "feature feature"]:
        """Lower Cholesky factor of the covariance."""
        return cholesky(self.covariance, lower=True)

    def _whiten(self, rows: Float[np.ndarray, "*row feature"]) -> Float[np.ndarray, "*row feature"]:
        """Rows in units in which the covariance is the identity."""
        flat = rows.reshape(-1, rows.shape[-1])
        return solve_triangular(self._root, flat.T, lower=True).T.reshape(rows.shape)


def _within(
    x: Float[np.ndarray, "sample feature"], cells: Cells
) -> tuple[
    Float[np.ndarray, "sample cell"], Float[np.ndarray, "sample cell direction"], Float[np.ndarray, "cell same same"]
]:
    """Density and position of observations in every cell of an even mixture of Gaussians, in white units.

    Cell m has the covariance I + U' U of its spread U; with A = I + U U' its inverse is I - U' A^-1 U and its
    determinant that of A (Woodbury), so that systems have the size of the number of directions.

    Returns
    -------
    array (sample, cell)
        Logarithm of each cell's part of the density, without the constant of the healthy class.
    array (sample, cell, direction)
        L^-1 U (x - shift) with A = L L'.
    array (cell, direction, direction)
        L.
    """
    shift, spread = cells.shift, cells.spread
    count, directions, features = spread.shape
    root = np.linalg.cholesky(np.eye(directions) + spread @ np.swapaxes(spread, 1, 2))
    scaled = np.linalg.solve(root, spread)
    square = (x**2).sum(axis=1)[:, None] - 2 * x @ shift.T + (shift**2).sum(axis=1)  # (sample, cell)
    along = (x @ scaled.reshape(-1, features).T).reshape(len(x), count, directions)
    along -= np.einsum("mdf,mf->md", scaled, shift)
    half_determinant = np.log(np.diagonal(root, axis1=1, axis2=2)).sum(axis=1)
    return -0.5 * (square - (along**2).sum(axis=2)) - half_determinant - log(count), along, root
