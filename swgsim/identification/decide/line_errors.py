"""Errors of lines: by how much the lines of an effect may differ on a gear of another structure.

There, no single share says how well the library knows an effect. A line that the library has may be right to 1 %, and
one that it hardly has may be a third of the largest. So every group of lines has an error of its own whose
standard deviation is known to a factor only, from the noise to a share of the largest line of the effect.

What turns with the wave generator passes the gauges one after the other, whatever the structure: a line of order k is a
wave of k periods around the circumference. What is uneven around the flex spline by m periods makes waves of k - m and
k + m. So the lines of the four single gauges are taken apart by wave, and lines of one order and wave are one group.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.linalg import qr
from scipy.special import logsumexp

from swgsim.chain.structure import LOAD_STEP
from swgsim.identification.data.features import Layout
from swgsim.identification.data.measured import Measured
from swgsim.identification.decide.prior import EXACT_LINE, LEAST_ERROR
from swgsim.storage.labelled_signals import SENSORS

# Standard deviations at which the integral over that of a group is taken.
LEVELS = 30
# Directions of a group below this part of its largest one are rounding.
LEAST_DIRECTION = 1e-6


class Groups(NamedTuple):
    """Columns of all groups of lines, orthogonal within each, for errors of one standard deviation of the noise.

    Attributes
    ----------
    columns : array (row, column)
    weights : array (row, column)
        The product of each with a signature is its size along a column.
    first : array (group,)
        First column of each group.
    of_mean : array (group,)
        Whether it holds offsets: they tell no size of an effect, as zeros move.
    """

    columns: Float[np.ndarray, "row column"]
    weights: Float[np.ndarray, "row column"]
    first: Int[np.ndarray, " group"]
    of_mean: Bool[np.ndarray, " group"]

    @property
    def counts(self) -> Int[np.ndarray, " group"]:
        """Number of columns of each group."""
        return np.diff(self.first, append=self.columns.shape[1])

    def largest(self, along: Float[np.ndarray, "signature column"]) -> Float[np.ndarray, " signature"]:
        """Root mean square of the lines of the largest group, in standard deviations of the noise.

        Parameters
        ----------
        along : array (signature, column)
            Products of signatures with :attr:`weights`.
        """
        square = np.add.reduceat(along**2, self.first, axis=-1) / self.counts
        return np.sqrt(square[..., ~self.of_mean].max(axis=-1))


@lru_cache(maxsize=2)
def groups(measured: Measured) -> Groups:
    """The groups of lines of a set of recordings.

    Lines may have another error at every load. In speed and torques these effects have no lines.
    """
    sigma = np.sqrt(measured.variance.ravel())[:, None]
    loads = np.round([each.point.T_out / LOAD_STEP for each in measured.recordings])
    columns, weights, counts, of_mean = [], [], [], []
    for order, patterns in _patterns(measured):
        of_mean.append(order == 0)
        counts.append(0)
        for load in np.unique(loads):
            Q = np.linalg.qr(np.kron((loads == load)[:, None], patterns) / sigma).Q
            root = np.sqrt((loads == load).sum())  # an error is as large in every recording, however many there are
            columns.append(Q * sigma * root)
            weights.append(Q / sigma / root)
            counts[-1] += Q.shape[1]
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    return Groups(np.hstack(columns), np.hstack(weights), first, np.array(of_mean))


def _patterns(measured: Measured) -> Iterator[tuple[int, Float[np.ndarray, "feature column"]]]:
    """The order of every group, and what its lines are in a recording, cosine and sine."""
    layout = measured.layout
    sensors = [name for name in SENSORS if name in layout.channels]
    single = [name for name in SENSORS[1:] if name in sensors]
    waves = range(len(single)) if len(single) == len(SENSORS) - 1 else ()
    alone = [name for name in sensors if not waves or name not in single]
    for order in range(int(layout.order.max()) + 1):
        for wave in waves:
            if order or wave < len(waves) - 1:  # a mean does not turn, so that a wave is that against it
                yield order, _columns(layout, {name: n * (wave - order) for n, name in enumerate(single)}, order)
        for name in alone:
            yield order, _columns(layout, {name: 0}, order)


def _columns(layout: Layout, quarters: Mapping[str, int], order: int) -> Float[np.ndarray, "feature column"]:
    """A line of an order in some channels, later in each by so many quarters of a period."""
    found = []
    for turn in (1, 1j):
        lines = np.zeros((len(layout.channels), int(layout.order.max()) + 1), complex)
        for name, quarter in quarters.items():
            lines[layout.channels.index(name), order] = turn * 1j**quarter
        found.append(layout.vector(lines))
    return np.stack([each for each in found if np.abs(each).max() > LEAST_DIRECTION], axis=1)


@dataclass(frozen=True, eq=False)
class LineErrors:
    """Errors of groups of lines, each group along its own directions.

    Attributes
    ----------
    columns : array (row, column)
        An error of one standard deviation of the noise along each direction, by its group alone.
    square : array (column,)
        Square of the same, whitened by what else the model does not know.
    first : array (group,)
        First column of each group.
    """

    columns: Float[np.ndarray, "row column"]
    square: Float[np.ndarray, " column"]
    first: Int[np.ndarray, " group"]

    @classmethod
    def of(
        cls, found: Groups, white: Float[np.ndarray, "row column"]
    ) -> tuple["LineErrors", Float[np.ndarray, "row column"]]:
        """Errors, and the directions of a whitened residual that they change: orthonormal.

        What a group has in common with one before, as by an error of the load, counts for that one.

        Parameters
        ----------
        found : Groups
        white : array (row, column)
            Columns of the groups, whitened.
        """
        directions, R = qr(white, mode="economic", check_finite=False)
        columns, square = np.empty_like(white), np.empty(white.shape[1])
        for first, count in zip(found.first, found.counts, strict=True):
            block = slice(first, first + count)
            U, s, Vt = np.linalg.svd(R[block, block])
            directions[:, block], square[block] = directions[:, block] @ U, s**2
            columns[:, block] = found.columns[:, block] @ Vt.T
        return cls(columns, square, found.first), directions

    def gain(
        self, along: Float[np.ndarray, "*batch try column"], bound: Float[np.ndarray, "*batch try"]
    ) -> Float[np.ndarray, "*batch try"]:
        """Gain of log-likelihood by the errors of all groups.

        Parameters
        ----------
        along : array (*batch, try, column)
            What a whitened residual has along each direction.
        bound : array (*batch, try)
            Largest standard deviation of an error, in those of the noise.
        """
        mean = logsumexp(self._gains(along, bound), axis=0) - np.log(LEVELS)
        return np.logaddexp(np.log(1 - EXACT_LINE) + mean, np.log(EXACT_LINE)).sum(axis=-1)

    def deviations(self, along: Float[np.ndarray, " column"], bound: float) -> Float[np.ndarray, " column"]:
        """Standard deviation that stands for that of the error along each direction.

        Its precision is the mean over the posterior, so that a fit with it raises the likelihood (expectation
        maximisation).
        """
        gains = self._gains(along, np.array(bound))
        top = np.maximum(gains.max(axis=0), 0.0)
        weights = np.exp(gains - top) * (1 - EXACT_LINE) / LEVELS
        exact = EXACT_LINE * np.exp(-top)
        counts = np.diff(self.first, append=len(self.square))
        weights, exact = (np.repeat(each / (weights.sum(axis=0) + exact), counts, axis=-1) for each in (weights, exact))
        variance = 1 + self._levels(np.array(bound))[:, None] ** 2 * self.square
        mean = exact + (weights / variance).sum(axis=0)
        seen = self.square > np.finfo(float).eps
        return np.sqrt(np.where(seen, 1 / mean - 1, 0.0) / np.where(seen, self.square, 1.0))

    def _levels(self, bound: Float[np.ndarray, "*batch"]) -> Float[np.ndarray, "level ..."]:
        return np.geomspace(LEAST_ERROR, np.maximum(bound, LEAST_ERROR), LEVELS)

    def _gains(
        self, along: Float[np.ndarray, "*batch column"], bound: Float[np.ndarray, "*batch"]
    ) -> Float[np.ndarray, "level ... group"]:
        """Gain by each group, for each standard deviation of its errors."""
        variance = self._levels(bound)[..., None] ** 2 * self.square
        each = along**2 * variance / (1 + variance) - np.log1p(variance)
        return np.add.reduceat(each, self.first, axis=-1) / 2
