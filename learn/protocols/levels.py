"""What is known of a gear never seen: the levels of target information, as pools of its recordings.

Z0: nothing. Z1: healthy acquisitions of the gear, its reference (what the paper assumes). Z2: besides, recordings
without labels. Z3: besides, K labelled variants of each class, the shots. Z4: the labels of the whole labelled pool.
The representation decides between Z0 and Z1 (``reference``); the pools here hold what Z2 to Z4 give.

A shot is one variant, a physical specimen, at all its operating points. The pools of a gear are disjoint, its reference
acquisitions are recordings of their own, and every method is given the same pools, shots and judged recordings.
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
    """The recordings of one gear that is not in training, as row numbers.

    Attributes
    ----------
    gear : int
    labelled : array (row,)
        From which shots are drawn; all of them are level Z4.
    unlabelled : array (row,)
        Known without their labels, level Z2.
    judged : array (row,)
        On which every method is judged.
    """

    gear: int
    labelled: Int[np.ndarray, " labelled"]
    unlabelled: Int[np.ndarray, " unlabelled"]
    judged: Int[np.ndarray, " judged"]

    def shots(self, table: pd.DataFrame, number: int, draw: int) -> Int[np.ndarray, " shot"]:
        """All recordings of `number` variants of each class, of the labelled ones.

        The variants of one draw are nested: those of 2 are among those of 5.

        Raises
        ------
        ValueError
            If there are fewer labelled variants of a class.
        """
        pool = table.iloc[self.labelled]
        if number and pool.empty:
            raise ValueError(
                f"{number} shots asked for, gear {self.gear} has 0 labelled variants: give the protocol labelled ones"
            )
        rows = [self.labelled[:0]]
        for label, of_class in pool.groupby("label", observed=True):
            variants = np.sort(of_class["variant"].unique())
            if number > len(variants):
                raise ValueError(
                    f"{number} shots of {label} asked for, gear {self.gear} has {len(variants)} labelled variants: "
                    "take fewer shots or a larger share of labelled variants"
                )
            order = generator("shots", self.gear, label, draw).permutation(variants)
            chosen = of_class.index[of_class["variant"].isin(order[:number])]
            rows.append(self.labelled[pool.index.get_indexer(chosen)])
        return np.sort(np.concatenate(rows))


@dataclass(frozen=True)
class Episode:
    """A split with its targets: train on `source`, adapt to each target and judge it.

    ``kept_out`` are rows of source gears that are not trained on: adapted models are judged on them as well, to see
    what they forget.
    """

    name: str
    source: Int[np.ndarray, " source"]
    kept_out: Int[np.ndarray, " kept"]
    targets: tuple[Target, ...]


@dataclass(frozen=True)
class NewGears:
    """Gears left out of training, in folds; the variants of each are dealt into pools.

    Attributes
    ----------
    folds : int
        The judged gears are dealt into so many folds, each of which is left out in turn; at most one gear to a fold.
    development : int
        Gears, those of the highest numbers, that are in the training set of every fold and never judged.
        Hyper-parameters are chosen on them, leaving some out in turn.
    judged : int or None
        Only so many gears, those of the lowest numbers, are judged, and none of them is in training: one fold. None for
        all but the development gears.
    labelled, unlabelled : int
        Variants of each class and gear in these pools; the others are judged.
    kept_out : int
        Variants of each class and source gear that are not trained on.
    variants : int or None
        Variants of each class and source gear to train on; None for all but those.
    sources : int or None
        Source gears to train on in each fold, development gears first; None for all.

    Raises
    ------
    ValueError
        If a number is out of its limits; when splitting, if there are too few gears or variants.
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
        """Zero-shot splits: the judged rows of each fold are tested."""
        for episode in self.episodes(table):
            yield _zero_shot(episode)

    def episodes(self, table: pd.DataFrame) -> Iterator[Episode]:
        """One episode per fold of judged gears."""
        gears = np.unique(table["gear"])
        judged = gears[: max(0, len(gears) - self.development)][: self.judged]
        yield from self._leaving_out(table, judged, gears, min(self.folds, len(judged)) if self.judged is None else 1)

    def development_splits(self, table: pd.DataFrame) -> Iterator[Split]:
        """Zero-shot splits of the development episodes."""
        for episode in self.development_episodes(table):
            yield _zero_shot(episode)

    def development_episodes(self, table: pd.DataFrame) -> Iterator[Episode]:
        """Episodes among the development gears alone, each of which is left out once."""
        gears = np.unique(table["gear"])[-self.development :] if self.development else np.empty(0, int)
        yield from self._leaving_out(table, gears, gears, min(DEVELOPMENT_FOLDS, len(gears)))

    def _leaving_out(self, table: pd.DataFrame, judged: np.ndarray, gears: np.ndarray, folds: int) -> Iterator[Episode]:
        if len(judged) < 1 or len(gears) < 2:
            raise ValueError(
                f"{len(judged)} gears to judge of {len(gears)} in all, with {self.development} kept for development: "
                "at least one must be left out and one remain; take a larger grid"
            )
        gear, variant = table["gear"].to_numpy(), table["variant"].to_numpy()
        kept_out = variant > variant.max() - self.kept_out
        trained = ~kept_out if self.variants is None else ~kept_out & (variant < self.variants)
        if not trained.any():
            raise ValueError(
                f"{variant.max() + 1} variants of which {self.kept_out} are kept out leave none to train on: "
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
                    f"{self.unlabelled} unlabelled leave none to judge: take smaller pools or more variants"
                )
            order = generator("pools", gear, label).permutation(variants)
            rank = np.argsort(order)[np.searchsorted(variants, variant)]
            pool[positions] = np.digitize(rank, [self.labelled, self.labelled + self.unlabelled])
        return Target(gear, rows[pool == 0], rows[pool == 1], rows[pool == 2])


def _zero_shot(episode: Episode) -> Split:
    return Split(episode.name, episode.source, np.sort(np.concatenate([target.judged for target in episode.targets])))
