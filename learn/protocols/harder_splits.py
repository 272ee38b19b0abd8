"""Harder questions of the same gears: faults milder or severer than any trained on, an operating point never seen.

A specimen (gear, class, variant) is on one side of a split only, with all its recordings. Gears are on both sides. In
the clean grid all healthy rows are identical, and their recall is free.
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
    """Train on all parts of the fault sizes but one and test on that one: the mild, the medium or the severe faults.

    The specimens of each fault class, of all gears together, are ordered by fault size and cut into parts as equal in
    number as can be. Equal sizes are never cut apart: each cut is put between the two neighbouring sizes where the
    number of specimens below is nearest to an equal share, and every part has at least one size. With as many sizes as
    parts, as the cracks of the paper's grid have, each part is one size. Specimens of healthy gears have no size; those
    of each gear are dealt into the parts at random.

    Attributes
    ----------
    parts : int
    seed : int
        Of the parts of healthy specimens.

    Raises
    ------
    ValueError
        If there are fewer than 2 parts; when splitting, if a fault class has fewer sizes than parts, or a gear fewer
        healthy specimens.
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
        """One split per part, which is tested; every row is tested once."""
        part = np.empty(len(table), dtype=int)
        for label, rows in table.groupby("label", observed=True).indices.items():
            of_class = table.iloc[rows]
            part[rows] = (
                _dealt(of_class, self.parts, "parts", self.seed)
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
    """For all parts but the first, the number of its first value; no part is empty."""
    below = np.append(0, np.cumsum(counts))
    cuts = [0]
    for part in range(1, parts):
        nearest = int(np.abs(below * parts - part * below[-1]).argmin())
        cuts.append(min(max(nearest, cuts[-1] + 1), len(counts) - parts + part))
    return cuts[1:]


@dataclass(frozen=True)
class LeaveOperatingPointOut:
    """Train at all operating points but one and test at that one, on other specimens.

    The specimens of each gear and class are dealt into groups at random. Trained are the rows of all groups but one at
    the other points, tested the rows of that one group at the point left out. To save time there is one split to a
    point and not one to each group and point: the points take the groups in turn, so that with 4 folds a quarter of the
    rows of each point is tested. The features at the point left out are still relative to the healthy reference there.

    Attributes
    ----------
    folds : int
        Groups of specimens.
    seed : int
        Of the groups.

    Raises
    ------
    ValueError
        If there are fewer than 2 folds; when splitting, if there are fewer than 2 operating points, or fewer specimens
        of a gear and class than folds.
    """

    folds: int = 4
    seed: int = 0

    def __post_init__(self) -> None:
        require_integer("the protocol", "folds", self.folds, low=2, high=10_000)

    def split(self, features: Inputs, table: pd.DataFrame) -> Iterator[Split]:
        """One split per operating point, named as ``2000 rpm, 7 N m``, from low to high speed and load."""
        points, point = np.unique(table[list(OPERATING_POINT)].to_numpy(), axis=0, return_inverse=True)
        if len(points) < 2:
            raise ValueError(
                f"{len(points)} operating point found, leaving one out needs at least 2: take a grid with more"
            )
        group = _dealt(table, self.folds, "folds", self.seed)
        for number, (speed, load) in enumerate(points):
            here, chosen = point.ravel() == number, group == number % self.folds  # NumPy 2.0 gives a column
            name = f"{_written(speed)} rpm, {_written(load)} N m"
            yield Split(name, np.flatnonzero(~here & ~chosen), np.flatnonzero(here & chosen))


def _written(value: float) -> str:
    """All digits and no exponent, whose sign may not stand in the name of a metric."""
    return np.format_float_positional(value, trim="-")


def _dealt(table: pd.DataFrame, number: int, what: str, seed: int) -> Int[np.ndarray, " row"]:
    """Which of `number` groups each row's specimen is in; those of each gear and class are dealt evenly, at random."""
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
