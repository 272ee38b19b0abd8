"""Splits of the rows into training and test: the paper's protocols, and folds that keep variants together."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
import pandas as pd
from jaxtyping import Int

from learn.inputs.inputs import SPECIMEN
from learn.inputs.rows import Inputs
from swgsim.common.checks import require_integer


class Split(NamedTuple):
    """Row numbers of training and test."""

    name: str
    train: Int[np.ndarray, " train"]
    test: Int[np.ndarray, " test"]


@runtime_checkable
class Splitting(Protocol):
    """A protocol, which divides the rows of a data set."""

    def split(self, features: Inputs, table: pd.DataFrame) -> Iterator[Split]:
        """Named splits of row numbers."""
        ...


@dataclass(frozen=True)
class RandomFolds:
    """The paper's cross-validation: shuffled folds with equal shares of the classes.

    Other operating points of a tested variant, and copies of a tested row, may be in training. In the clean grid all
    healthy rows are identical, so their recall means nothing.

    Raises
    ------
    ValueError
        If there are fewer than 2 folds.
    """

    folds: int = 4
    seed: int = 0

    def __post_init__(self) -> None:
        require_integer("the protocol", "folds", self.folds, low=2, high=10_000)

    def split(self, features: Inputs, table: pd.DataFrame) -> Iterator[Split]:
        """One split per fold; every row is tested once."""
        from sklearn.model_selection import StratifiedKFold

        _enough(table["label"].value_counts(), self.folds)
        folds = StratifiedKFold(self.folds, shuffle=True, random_state=self.seed)
        for number, (train, test) in enumerate(folds.split(features, table["label"]), start=1):
            yield Split(f"fold {number}", train, test)


@dataclass(frozen=True)
class GroupedFolds:
    """Folds that keep all recordings of a variant together, and all variants with an equal row of features.

    Rows are equal if they agree to 9 decimals. If all variants of a class are connected by equal rows, its recall
    cannot be measured. Such rows, as all healthy rows of the clean grid, are always in training and never tested.

    Raises
    ------
    ValueError
        If there are fewer than 2 folds. In ``split``: if there are fewer independent groups of variants than folds.
    """

    folds: int = 4
    seed: int = 0

    def __post_init__(self) -> None:
        require_integer("the protocol", "folds", self.folds, low=2, high=10_000)

    def split(self, features: Inputs, table: pd.DataFrame) -> Iterator[Split]:
        """One split per fold; every testable row is tested once."""
        from sklearn.model_selection import StratifiedGroupKFold

        label = table["label"].astype(str).to_numpy()
        group = independent_groups(features, table)
        testable = ~np.isin(group, _groups_of_a_whole_class(group, label))
        rows = np.flatnonzero(testable)
        if len(np.unique(group[rows])) < self.folds:
            raise ValueError(
                f"{len(np.unique(group[rows]))} independent groups of variants are fewer than {self.folds} folds: "
                "take fewer folds or more variants"
            )
        _enough(pd.Series(label[rows]).value_counts(), self.folds)
        folds = StratifiedGroupKFold(self.folds, shuffle=True, random_state=self.seed)
        for number, (_, test) in enumerate(folds.split(rows, label[rows], group[rows]), start=1):
            yield Split(f"fold {number}", np.setdiff1d(np.arange(len(label)), rows[test]), rows[test])


def independent_groups(features: Inputs, table: pd.DataFrame) -> Int[np.ndarray, " row"]:
    """Group number of each row: the connected components of the graph of variants and distinct rows of features."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    variant = table.groupby(list(SPECIMEN), observed=True).ngroup().to_numpy()
    _, content = np.unique(np.round(features, 9), axis=0, return_inverse=True)
    node = variant.max() + 1 + content.ravel()  # a column in NumPy 2.0
    size = node.max() + 1
    graph = coo_array((np.ones(len(table)), (variant, node)), shape=(size, size))
    _, component = connected_components(graph, directed=False)
    return component[variant]


def _groups_of_a_whole_class(group: Int[np.ndarray, " row"], label: np.ndarray) -> np.ndarray:
    groups_of_class = pd.Series(group).groupby(label).unique()
    return np.array([groups[0] for groups in groups_of_class if len(groups) == 1], dtype=int)


@dataclass(frozen=True)
class LeaveOneGearOut:
    """Leave out one gear for the test, as in Table IX: 1,2->3; 2,3->1; 1,3->2.

    If there are more gears than `folds`, each fold has several gears. As in the paper, features of the left-out gear
    are relative to its healthy reference, so healthy rows of the clean grid are identical in all gears.

    Raises
    ------
    ValueError
        If there are fewer than 2 folds. In ``split``: if there are fewer than 2 gears.
    """

    folds: int = 5

    def __post_init__(self) -> None:
        require_integer("the protocol", "folds", self.folds, low=2, high=10_000)

    def split(self, features: Inputs, table: pd.DataFrame) -> Iterator[Split]:
        """One split per gear or per fold of gears."""
        gear = table["gear"].to_numpy()
        gears = np.unique(gear)
        if len(gears) < 2:
            raise ValueError(f"{len(gears)} gear found, leaving one out needs at least 2: take a larger grid")
        number = min(len(gears), self.folds)
        for left_out in np.roll(np.arange(number), 1):
            tested = gears[left_out::number]
            trained = np.setdiff1d(gears, tested)
            test = np.isin(gear, tested)
            yield Split(f"{_listed(trained)}->{_listed(tested)}", np.flatnonzero(~test), np.flatnonzero(test))


def _listed(gears: np.ndarray) -> str:
    return ",".join(str(g) for g in gears)


def _enough(counts: pd.Series, folds: int) -> None:
    counts = counts[counts > 0]
    if counts.min() < folds:
        raise ValueError(
            f"class {counts.idxmin()} has {counts.min()} rows, fewer than {folds} folds: "
            "take fewer folds or more variants"
        )
