"""What effects can put between the orders of a recording, gauge by gauge: a gauge that is silent costs nothing."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

# Share of a pattern that must lie between the orders; less is rounding. And share of a pattern's largest direction that
# any other direction must have.
LEAST_SHARE = 1e-3


class SeenLines(NamedTuple):
    """Patterns of some effects, of one or more columns each. A column has a part for every gauge that is not silent.

    Attributes
    ----------
    effect : array (column,)
        Number of the effect.
    column, gauge : array (part,)
        Numbers of the column and of the gauge.
    numbers : array (part, number)
        The part, in units of the noise.
    norm : array (part,)
        Of the part with what lies on the orders.
    """

    effect: Int[np.ndarray, " column"]
    column: Int[np.ndarray, " part"]
    gauge: Int[np.ndarray, " part"]
    numbers: Float[np.ndarray, "part number"]
    norm: Float[np.ndarray, " part"]

    def apart(self, gauges: Sequence[int]) -> "SeenLines":
        """Some gauges, each with effects of its own."""
        own = np.isin(self.gauge, gauges)
        numbers = np.stack([self.effect[self.column], self.gauge])[:, own]
        effect = np.unique(numbers, axis=1, return_inverse=True)[1].ravel()
        return SeenLines(effect, np.arange(len(effect)), self.gauge[own], self.numbers[own], self.norm[own])

    def shows(self, square: Float[np.ndarray, " column"]) -> Bool[np.ndarray, " column"]:
        """Whether the effects of columns with these sums of squares are more than rounding."""
        whole = np.bincount(self.column, self.norm**2, len(self.effect))
        most, least = np.zeros((2, int(self.effect.max(initial=-1)) + 1))
        np.maximum.at(most, self.effect, square)
        np.maximum.at(least, self.effect, LEAST_SHARE**2 * whole)
        return np.asarray(most > least)[self.effect]

    def shown(self, columns: Float[np.ndarray, "column number"]) -> Float[np.ndarray, "column number"]:
        """Dense columns, 0 where their effect is no more than rounding."""
        return columns * self.shows((columns**2).sum(axis=1))[:, None]

    def along(self, directions: Float[np.ndarray, "gauge number direction"]) -> Float[np.ndarray, "column direction"]:
        """Products of the columns with directions."""
        found = np.zeros((len(self.effect), directions.shape[-1]))
        for gauge in np.unique(self.gauge):
            own = self.gauge == gauge
            found[self.column[own]] += self.numbers[own] @ directions[gauge]
        return found

    def products(self) -> Float[np.ndarray, "column column"]:
        """Products of the columns with one another."""
        found = np.zeros((len(self.effect), len(self.effect)))
        for gauge in np.unique(self.gauge):
            own = self.gauge == gauge
            found[np.ix_(self.column[own], self.column[own])] += self.numbers[own] @ self.numbers[own].T
        return found

    def dense(self, gauges: int) -> Float[np.ndarray, "column number"]:
        """The columns over all of so many gauges, one after the other."""
        found = np.zeros((len(self.effect), gauges, self.numbers.shape[1]))
        found[self.column, self.gauge] = self.numbers
        return found.reshape(len(found), -1)


def orthonormal(products: Float[np.ndarray, "*batch column column"]) -> Float[np.ndarray, "*batch column rank"]:
    """How columns, of which the products with one another are given, make orthonormal directions; or those of each of
    several batches, of which one may have fewer directions: its first ones are 0.
    """
    power, axes = np.linalg.eigh(products)
    used = power > LEAST_SHARE**2 * max(float(power.max(initial=0.0)), 1e-300)
    turned = axes * (used / np.sqrt(np.where(used, power, 1.0)))[..., None, :]
    return turned[..., used.any(axis=tuple(range(used.ndim - 1)))]
