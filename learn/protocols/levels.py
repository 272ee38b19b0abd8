"""Levels of target information, as pools of recordings of a gear that is not in training.

====  ======================================================================
Z0    nothing is known of the target gear
Z1    its healthy reference, as the paper assumes
Z2    Z1, and recordings without labels
Z3    Z1, and K labelled variants of each class, the shots
Z4    Z1, and all variants of the labelled pool
====  ======================================================================

The representation decides between Z0 and Z1 (``reference``); the pools serve Z2 to Z4. A shot is one variant, a
physical specimen, at all its operating points. Pools of a gear are disjoint, and reference acquisitions are in none of
them. All methods receive the same pools, shots and judged recordings.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Int

from learn.protocols.splits import Split
from swgsim.common.checks import require_integer
from swgsim.common.seeds import generator

DEVELOPMENT_FOLDS = 3


@dataclass(frozen=True)
class Target:
    """Row numbers of one gear that is not in training.

    Attributes
    ----------
    gear : int
    labelled : array (row,)
        Pool of the shots; all of it is level Z4.
    unlabelled : array (row,)
        Pool of level Z2.
    judged : array (row,)
        Rows on which all methods are judged.
    """

    gear: int
    labelled: Int[np.ndarray, " labelled"]
    unlabelled: Int[np.ndarray, " unlabelled"]
    judged: Int[np.ndarray, " judged"]

    def shots(self, table: pd.DataFrame, number: int, draw: int) -> Int[np.ndarray, " shot"]:
        """Rows of `number` labelled variants of each class; within a draw, more shots include fewer.

        Raises
        ------
        ValueError
            If a class has fewer labelled variants.
        """
        pool = table.iloc[self.labelled]
        if number and pool.empty:
            raise ValueError(
                f"{number} shots requested, gear {self.gear} has 0 labelled variants: set labelled of the protocol"
            )
        rows = [self.labelled[:0]]
        for label, of_class in pool.groupby("label", observed=True):
            variants = np.sort(of_class["variant"].unique())
            if number > len(variants):
                raise ValueError(
                    f"{number} shots of {label} requested, gear {self.gear} has {len(variants)} labelled variants: "
                    "take fewer shots or a larger share of labelled variants"
                )
            order = generator("shots", self.gear, label, draw).permutation(variants)
            chosen = of_class.index[of_class["variant"].isin(order[:number])]
            rows.append(self.labelled[pool.index.get_indexer(chosen)])
        return np.sort(np.concatenate(rows))


@dataclass(frozen=True)
class Episode:
    """A split with targets: training on `source`, then adaptation to each target and its evaluation.

    ``kept_out`` are rows of source gears that are not in training. Adapted models are also evaluated on them, which
    shows what they forget.
    """

    name: str
    source: Int[np.ndarray, " source"]
    kept_out: Int[np.ndarray, " kept"]
    targets: tuple[Target, ...]

    def of_recordings(self, count: int) -> "Episode":
        """The same episode in row numbers of recordings, where each row stands for so many in a row."""

        def each(rows: Int[np.ndarray, " row"]) -> Int[np.ndarray, " recording"]:
            return (rows[:, None] * count + np.arange(count)).ravel()

        targets = (Target(t.gear, each(t.labelled), each(t.unlabelled), each(t.judged)) for t in self.targets)
        return Episode(self.name, each(self.source), each(self.kept_out), tuple(targets))


@dataclass(frozen=True)
class NewGears:
    """Gears left out of training, in folds, with their variants in pools.

    Attributes
    ----------
    folds : int
        Number of folds of judged gears; each fold is left out in turn and has at least one gear.
    development : int
        Number of development gears, those of the highest numbers. They are in every training set and never judged.
        Hyper-parameters are chosen on them for each fold, by models of the fold's other source gears.
    judged : int or None
        Number of judged gears, those of the lowest numbers, as one fold; None: all but the development gears.
    labelled, unlabelled : int
        Variants of each class and gear in these pools; the other variants are judged.
    kept_out : int
        Variants of each class and source gear that are not in training.
    variants : int or None
        Variants of each class and source gear in training; None: all but ``kept_out``.
    sources : int or None
        Source gears in training in each fold, development gears first; None: all.

    Raises
    ------
    ValueError
        If a number is out of its limits. In ``split``: if there are too few gears or variants.
    """

    folds: int = 5
    development: int = 6
    judged: int | None = None
    labelled: int = 14
    unlabelled: int = 6
    kept_out: int = 2
    variants: int | None = None
    sources: int | None = None

    def __post_init__(self) -> None:
        require_integer("the protocol", "folds", self.folds, low=2, high=10_000)
        for name in ("development", "labelled", "unlabelled", "kept_out"):
            require_integer("the protocol", name, getattr(self, name), low=0, high=10_000)
        for name in ("judged", "variants", "sources"):
            if getattr(self, name) is not None:
                require_integer("the protocol", name, getattr(self, name), low=1, high=1_000_000)

    def split(self, features: object, table: pd.DataFrame) -> Iterator[Split]:
        """Splits without adaptation: the judged rows of each fold are tested."""
        for episode in self.episodes(table):
            yield zero_shot_split(episode)

    def episodes(self, table: pd.DataFrame) -> Iterator[Episode]:
        """One episode for each fold of judged gears."""
        gears = np.unique(table["gear"])
        judged = gears[: max(0, len(gears) - self.development)][: self.judged]
        yield from self._leaving_out(table, judged, gears, min(self.folds, len(judged)) if self.judged is None else 1)

    def development_episodes(self, table: pd.DataFrame, episode: Episode) -> list[Episode]:
        """Episodes whose targets are the development gears, to choose the options of an episode.

        Their sources are the other source gears of the episode, about as many as the options are used with. The gears
        that it judges have no say. If it has development gears only, they are left out in turn. One source gear leaves
        nothing to choose from.
        """
        known = np.unique(table["gear"].to_numpy()[episode.source])
        every = np.unique(table["gear"])
        development = np.intersect1d(known, every[len(every) - self.development :])
        if len(known) < 2:
            return []
        alone = len(development) == len(known)
        return list(self._leaving_out(table, development, known, min(DEVELOPMENT_FOLDS, len(known)) if alone else 1))

    def _leaving_out(self, table: pd.DataFrame, judged: np.ndarray, gears: np.ndarray, folds: int) -> Iterator[Episode]:
        if len(judged) < 1 or len(gears) < 2:
            raise ValueError(
                f"{len(judged)} gears to judge of {len(gears)} in all, with {self.development} for development: "
                "at least one must be left out and one remain; take a larger grid"
            )
        gear, variant = table["gear"].to_numpy(), table["variant"].to_numpy()
        kept_out = variant > variant.max() - self.kept_out
        trained = ~kept_out if self.variants is None else ~kept_out & (variant < self.variants)
        if not trained.any():
            raise ValueError(
                f"{variant.max() + 1} variants, of which {self.kept_out} are kept out, leave 0 for training: "
                "keep out fewer or take more variants"
            )
        for number in range(folds):
            left_out = judged[number::folds]
            known = np.setdiff1d(gears, left_out)[::-1][: self.sources]
            source = np.isin(gear, known)
            targets = tuple(self._target(table, int(each)) for each in left_out)
            yield Episode(
                f"fold {number + 1}", np.flatnonzero(source & trained), np.flatnonzero(source & kept_out), targets
            )

    def _target(self, table: pd.DataFrame, gear: int) -> Target:
        rows = np.flatnonzero(table["gear"].to_numpy() == gear)
        pool = np.empty(len(rows), dtype=int)
        for label, positions in table.iloc[rows].groupby("label", observed=True).indices.items():
            variant = table["variant"].to_numpy()[rows[positions]]
            variants = np.unique(variant)
            if len(variants) <= self.labelled + self.unlabelled:
                raise ValueError(
                    f"gear {gear} has {len(variants)} variants of {label}, {self.labelled} labelled and "
                    f"{self.unlabelled} unlabelled leave 0 to judge: take smaller pools or more variants"
                )
            order = generator("pools", gear, label).permutation(variants)
            rank = np.argsort(order)[np.searchsorted(variants, variant)]
            pool[positions] = np.digitize(rank, [self.labelled, self.labelled + self.unlabelled])
        return Target(gear, rows[pool == 0], rows[pool == 1], rows[pool == 2])


def zero_shot_split(episode: Episode) -> Split:
    """The split of an episode without adaptation."""
    return Split(episode.name, episode.source, np.sort(np.concatenate([target.judged for target in episode.targets])))
