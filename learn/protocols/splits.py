"""What is trained on and what is tested: the paper's protocols, and folds that keep a variant on one side.

Every protocol has one method, ``split(features, table)``, which yields named splits of row numbers.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
import pandas as pd
from jaxtyping import Int

from learn.inputs.inputs import SPECIMEN
from learn.inputs.rows import Inputs


class Split(NamedTuple):
    """Row numbers to train on and to test on."""

    name: str
    train: Int[np.ndarray, " train"]
    test: Int[np.ndarray, " test"]


@runtime_checkable
class Splitting(Protocol):
    """A rule that divides the rows of a data set."""

    def split(self, features: Inputs, table: pd.DataFrame) -> Iterator[Split]:
        """The splits, one after another."""
        ...


@dataclass(frozen=True)
class RandomFolds:
    """The paper's cross-validation: shuffled folds of equal class shares.

    A variant's other operating points, and rows identical to a tested one, may be trained on. In the clean grid all
    healthy rows are identical, so their recall is free.

    Raises
    ------
    ValueError
        If there are fewer than 2 folds.
    """

    folds: int = 4
    seed: int = 0

    def __post_init__(self) -> None:
        _at_least_two(self.folds)

    def split(self, features: Inputs, table: pd.DataFrame) -> Iterator[Split]:
        """One split per fold, named ``fold 1`` and so on; every row is tested once."""
        from sklearn.model_selection import StratifiedKFold

        _enough(table["label"].value_counts(), self.folds, "rows")
        folds = StratifiedKFold(self.folds, shuffle=True, random_state=self.seed)
        for number, (train, test) in enumerate(folds.split(features, table["label"]), start=1):
            yield Split(f"fold {number}", train, test)


@dataclass(frozen=True)
class GroupedFolds:
    """Folds that hold all recordings of a variant (gear, class, variant), and all rows with the same features.

    Variants that share a row of features, to 9 decimals, count as one: a row is never on both sides, and neither is a
    copy of it. Where all rows of a class hang together like this (in the clean grid every healthy row is the same row)
    its recall cannot be measured: these rows are in the training set of every fold and never tested. They still count
    against a method that takes a fault for healthy.

    Raises
    ------
    ValueError
        If there are fewer than 2 folds; when splitting, if there are fewer independent groups of variants than folds.
    """

    folds: int = 4
    seed: int = 0

    def __post_init__(self) -> None:
        _at_least_two(self.folds)

    def split(self, features: Inputs, table: pd.DataFrame) -> Iterator[Split]:
        """One split per fold, named ``fold 1`` and so on; every row that can be tested is tested once."""
        from sklearn.model_selection import StratifiedGroupKFold

        label = table["label"].astype(str).to_numpy()
        group = independent_groups(features, table)
        testable = ~np.isin(group, _groups_that_hold_a_whole_class(group, label))
        rows = np.flatnonzero(testable)
        if len(np.unique(group[rows])) < self.folds:
            raise ValueError(
                f"{len(np.unique(group[rows]))} independent groups of variants are fewer than {self.folds} folds: "
                "take fewer folds or more variants"
            )
        _enough(pd.Series(label[rows]).value_counts(), self.folds, "rows")
        folds = StratifiedGroupKFold(self.folds, shuffle=True, random_state=self.seed)
        for number, (_, test) in enumerate(folds.split(rows, label[rows], group[rows]), start=1):
            yield Split(f"fold {number}", np.setdiff1d(np.arange(len(label)), rows[test]), rows[test])


def independent_groups(features: Inputs, table: pd.DataFrame) -> Int[np.ndarray, " row"]:
    """Number of each row's group: rows of one variant, and rows with equal features (to 9 decimals), belong together.

    The groups are the connected components of the graph whose nodes are variants and distinct rows of features.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    variant = table.groupby(list(SPECIMEN), observed=True).ngroup().to_numpy()
    _, content = np.unique(np.round(features, 9), axis=0, return_inverse=True)
    node = variant.max() + 1 + content.ravel()  # of NumPy 2.0 a column
    size = node.max() + 1
    graph = coo_array((np.ones(len(table)), (variant, node)), shape=(size, size))
    _, component = connected_components(graph, directed=False)
    return component[variant]


def _groups_that_hold_a_whole_class(group: Int[np.ndarray, " row"], label: np.ndarray) -> np.ndarray:
    groups_of_class = pd.Series(group).groupby(label).unique()
    return np.array([groups[0] for groups in groups_of_class if len(groups) == 1], dtype=int)


@dataclass(frozen=True)
class LeaveOneGearOut:
    """Train on all gears but one and test on that one, which is out of distribution; named as in Table IX: ``1,2->3``.

    With more gears than `folds`, the gears are dealt into that many folds and each fold is left out in turn. The order
    is the paper's: 1,2->3; 2,3->1; 1,3->2. As in the paper, the features of the gear left out are relative to its own
    healthy reference; healthy rows of the clean grid are therefore identical in all gears.

    Raises
    ------
    ValueError
        If there are fewer than 2 folds; when splitting, if there are fewer than 2 gears.
    """

    folds: int = 5

    def __post_init__(self) -> None:
        _at_least_two(self.folds)

    def split(self, features: Inputs, table: pd.DataFrame) -> Iterator[Split]:
        """One split per gear, or per fold of gears."""
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


def _at_least_two(folds: int) -> None:
    if folds < 2:
        raise ValueError(f"{folds} folds given, at least 2 are needed to train and to test; the paper takes 4")


def _enough(counts: pd.Series, folds: int, what: str) -> None:
    counts = counts[counts > 0]
    if counts.min() < folds:
        raise ValueError(
            f"class {counts.idxmin()} has {counts.min()} {what}, fewer than {folds} folds: "
            "take fewer folds or more variants"
        )
