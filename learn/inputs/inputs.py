"""What every method is given: one row of numbers per recording, and the facts beside it."""

from collections.abc import Callable, Hashable, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from learn.inputs.rows import Inputs, on_disk
from swgsim.storage.labelled_signals import LabelledSignals

OPERATING_POINT = ("n_in_rpm", "T_out_nm")
SPECIMEN = ("gear", "label", "variant")  # a physical unit, recorded at several operating points


class Layout(NamedTuple):
    """How a row begins: `channels` times `points` values of signal, channel after channel; side inputs follow.

    The points of a periodic signal are angles of a revolution; of one that is not they are features in a row, each with
    a scale of its own.
    """

    channels: int = 0
    points: int = 0
    periodic: bool = True

    @property
    def columns(self) -> int:
        """Columns of signal."""
        return self.channels * self.points


NO_SIGNAL = Layout()


@dataclass(frozen=True)
class LearningSet:
    """The inputs of all samples, in the columns that `names` names; and their facts.

    Attributes
    ----------
    features : array (sample, feature)
        Of a large data set, rows in a file.
    table : DataFrame
        One row of facts per sample, with the columns of :data:`swgsim.storage.labelled_signals.COLUMNS`.
    names : tuple of str
        One per feature.
    layout : Layout
        Which columns are a signal; methods that know no signals take all columns alike.
    """

    features: Inputs
    table: pd.DataFrame
    names: tuple[str, ...]
    layout: Layout = NO_SIGNAL


def beside_foreign(data: LearningSet, foreign: LearningSet) -> LearningSet:
    """A data set joined by gears of another one, which get the numbers below 1 and so come first.

    Raises
    ------
    ValueError
        If the two have different inputs.
    """
    if data.names != foreign.names:
        raise ValueError(f"{len(data.names)} and {len(foreign.names)} inputs that differ: take the same ones of both")
    table = foreign.table.assign(gear=foreign.table["gear"] - foreign.table["gear"].max())
    return LearningSet(
        np.concatenate([foreign.features, data.features]),
        pd.concat([table, data.table], ignore_index=True),
        data.names,
        data.layout,
    )


@runtime_checkable
class Representation(Hashable, Protocol):
    """A way to make inputs of recordings; equal ones are interchangeable."""

    def learning_set(self, blocks: Iterable[LabelledSignals]) -> LearningSet:
        """The inputs of the samples of a data set, which comes in one block or in many that are dropped one by one."""
        ...


def gear_by_gear(
    blocks: Iterable[LabelledSignals], representation: Representation, folder: Path, progress: Callable[[int], object]
) -> LearningSet:
    """The inputs of a data set that is too large for the memory, one gear after the other, in a file.

    A gear is a data set of its own: inputs are set in relation to no other gear.

    Parameters
    ----------
    blocks : iterable of LabelledSignals
        The recordings of a gear in a row, as data sets have them.
    representation : Representation
    folder : Path
        Where the file may lie; it has no name and leaves nothing behind.
    progress : callable
        Called with the number of recordings whenever that many more are done.

    Raises
    ------
    ValueError
        If the recordings of a gear are not in a row.
    """
    facts: list[LearningSet] = []

    def features() -> Iterator[Float[np.ndarray, "sample feature"]]:
        for recordings in _gears(blocks):
            made = representation.learning_set(recordings)
            facts.append(replace(made, features=np.empty((0, len(made.names)))))
            progress(sum(map(len, recordings)))
            yield np.asarray(made.features)

    rows = on_disk(features(), folder)
    table = pd.concat([each.table for each in facts], ignore_index=True)
    return LearningSet(rows, table, facts[0].names, facts[0].layout)


def _gears(blocks: Iterable[LabelledSignals]) -> Iterator[list[LabelledSignals]]:
    """The recordings of each gear."""
    pieces = (block.where(rows) for block in blocks for rows in _runs(block.table["gear"].to_numpy()))
    before: set[int] = set()
    for gear, held in groupby(pieces, key=lambda piece: int(piece.table["gear"].iloc[0])):
        if gear in before:
            raise ValueError(f"recordings of gear {gear} in two places of the data set: they must be in a row")
        before.add(gear)
        yield list(held)


def _runs(values: Int[np.ndarray, " row"]) -> list[Int[np.ndarray, " run"]]:
    """Row numbers of equal values in a row."""
    return np.split(np.arange(len(values)), np.flatnonzero(np.diff(values)) + 1)
