"""Splits with known gears that are harder than random folds: other fault sizes, or another operating point.

All recordings of a specimen (gear, class, variant) are on one side of a split. Gears are on both sides. In the clean
grid all healthy rows are identical, so their recall means nothing.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Int

from learn.inputs.inputs import OPERATING_POINT
from learn.inputs.rows import Inputs
from learn.protocols.fault_size import size
from learn.protocols.splits import Split
from swgsim.common.checks import require_integer
from swgsim.common.seeds import generator


@dataclass(frozen=True)
class LeaveSeverityOut:
    """Leave out a part of the fault sizes for the test: the mild, the medium or the severe faults.

    The specimens of each fault class, of all gears together, are ordered by fault size and cut into parts of nearly
    equal number. Equal sizes stay together: each cut lies between two neighbouring sizes, where the number of specimens
    below is nearest to an equal share. Every part has at least one size; the cracks of the paper's grid have one size
    in each part. Healthy specimens have no size; those of each gear are distributed over the parts at random.

    Attributes
    ----------
    parts : int
    seed : int
        Seed of the parts of healthy specimens.

    Raises
    ------
    ValueError
        If there are fewer than 2 parts. In ``split``: if a class has fewer sizes than parts, or a gear fewer healthy
        specimens.
    """

    parts: int = 3
    seed: int = 0

    def __post_init__(self) -> None:
        require_integer("the protocol", "parts", self.parts, low=2, high=10_000)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parts, from the smallest faults to the largest."""
        if self.parts == 3:
            return ("mild", "medium", "severe")
        return tuple(f"part {number} of {self.parts}" for number in range(1, self.parts + 1))

    def split(self, features: Inputs, table: pd.DataFrame) -> Iterator[Split]:
        """One split per part; every row is tested once."""
        part = np.empty(len(table), dtype=int)
        for label, rows in table.groupby("label", observed=True).indices.items():
            of_class = table.iloc[rows]
            part[rows] = (
                _random_groups(of_class, self.parts, "parts", self.seed)
                if label == "healthy"
                else self._parts_by_size(str(label), of_class)
            )
        for number, name in enumerate(self.names):
            yield Split(name, np.flatnonzero(part != number), np.flatnonzero(part == number))

    def _parts_by_size(self, label: str, of_class: pd.DataFrame) -> Int[np.ndarray, " row"]:
        sizes = pd.Series(size(label, of_class["severity"].to_numpy()), index=of_class.index)
        specimens = sizes[~of_class.duplicated(["gear", "variant"])]
        values, counts = np.unique(specimens, return_counts=True)
        if len(values) < self.parts:
            raise ValueError(
                f"class {label} has {len(values)} severities, fewer than {self.parts} parts: "
                "take fewer parts or more severities"
            )
        return np.searchsorted(values[_cuts(counts, self.parts)], sizes, side="right")


def _cuts(counts: Int[np.ndarray, " value"], parts: int) -> list[int]:
    """Number of the first value of every part but the first; no part is empty."""
    below = np.append(0, np.cumsum(counts))
    cuts = [0]
    for part in range(1, parts):
        nearest = int(np.abs(below * parts - part * below[-1]).argmin())
        cuts.append(min(max(nearest, cuts[-1] + 1), len(counts) - parts + part))
    return cuts[1:]


@dataclass(frozen=True)
class LeaveOperatingPointOut:
    """Leave out an operating point, and test there on other specimens than those of training.

    The specimens of each gear and class are divided into groups at random. Each split leaves out one point and one
    group: it trains on the other groups at the other points, and tests the one group at the one point. There is one
    split per point, and the points use the groups in turn; with 4 folds, a quarter of the rows of a point is tested.
    Features at the left-out point are still relative to its healthy reference.

    Attributes
    ----------
    folds : int
        Number of groups of specimens.
    seed : int
        Seed of the groups.

    Raises
    ------
    ValueError
        If there are fewer than 2 folds. In ``split``: if there are fewer than 2 operating points or none, or fewer
        specimens of a gear and class than folds.
    """

    folds: int = 4
    seed: int = 0

    def __post_init__(self) -> None:
        require_integer("the protocol", "folds", self.folds, low=2, high=10_000)

    def split(self, features: Inputs, table: pd.DataFrame) -> Iterator[Split]:
        """One split per operating point, such as ``2000 rpm, 7 N m``, in ascending order of speed and load."""
        points, point = np.unique(table[list(OPERATING_POINT)].to_numpy(), axis=0, return_inverse=True)
        if not np.isfinite(points).all():
            raise ValueError("rows of units have no operating point that could be left out: take rows=recording")
        if len(points) < 2:
            raise ValueError(
                f"{len(points)} operating point found, leaving one out needs at least 2: take a grid with more"
            )
        group = _random_groups(table, self.folds, "folds", self.seed)
        for number, (speed, load) in enumerate(points):
            here, chosen = point.ravel() == number, group == number % self.folds  # NumPy 2.0 gives a column
            name = f"{_decimal(speed)} rpm, {_decimal(load)} N m"
            yield Split(name, np.flatnonzero(~here & ~chosen), np.flatnonzero(here & chosen))


def _decimal(value: float) -> str:
    """All digits without an exponent, as names of metrics allow no plus sign."""
    return np.format_float_positional(value, trim="-")


def _random_groups(table: pd.DataFrame, number: int, what: str, seed: int) -> Int[np.ndarray, " row"]:
    """Number of the random group of each row's specimen; groups of a gear and class have nearly equal sizes."""
    group = np.empty(len(table), dtype=int)
    for rows in table.groupby(["gear", "label"], observed=True).indices.values():
        gear, label = table["gear"].iloc[rows[0]], table["label"].iloc[rows[0]]
        variants, variant = np.unique(table["variant"].to_numpy()[rows], return_inverse=True)
        if len(variants) < number:
            raise ValueError(
                f"gear {gear} has {len(variants)} variants of {label}, fewer than {number} {what}: "
                f"take fewer {what} or more variants"
            )
        group[rows] = generator(f"dealt into {what}", seed, gear, label).permutation(len(variants))[variant] % number
    return group
