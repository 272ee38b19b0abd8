"""The data of every method: one row of features per recording, and a table of facts."""

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
SPECIMEN = ("gear", "label", "variant")  # identify a physical specimen, recorded at several operating points


class Layout(NamedTuple):
    """Place of the signal in a row: first `channels` times `points` values, channel by channel, then other inputs.

    The points of a periodic signal are angles of a revolution. Those of another signal are features, each with a
    separate scale.
    """

    channels: int = 0
    points: int = 0
    periodic: bool = True

    @property
    def columns(self) -> int:
        """Number of columns of the signal."""
        return self.channels * self.points


NO_SIGNAL = Layout()


@dataclass(frozen=True)
class LearningSet:
    """Inputs of all samples with their facts.

    Attributes
    ----------
    features : array (sample, feature)
        :class:`learn.inputs.rows.Rows` in a file if the data set is large.
    table : DataFrame
        One row of facts per sample, with the columns of :data:`swgsim.storage.labelled_signals.COLUMNS`.
    names : tuple of str
        Names of the features.
    layout : Layout
        Columns of the signal.
    recordings : LearningSet or None
        Of rows of units (:func:`learn.inputs.joint_rows.joint_rows`), those of their recordings, unit by unit.
    """

    features: Inputs
    table: pd.DataFrame
    names: tuple[str, ...]
    layout: Layout = NO_SIGNAL
    recordings: "LearningSet | None" = None


def with_foreign_gears(data: LearningSet, foreign: LearningSet) -> LearningSet:
    """Both data sets as one; the foreign gears come first, with numbers below 1; raises like :func:`_joined`."""
    return _joined(_renumbered(foreign, -int(foreign.table["gear"].max())), data)


def with_training_gears(data: LearningSet, training: LearningSet) -> LearningSet:
    """Both data sets as one; the training gears come last, with the highest numbers; raises like :func:`_joined`."""
    return _joined(data, _renumbered(training, int(data.table["gear"].max())))


def _renumbered(data: LearningSet, by: int) -> LearningSet:
    return replace(data, table=data.table.assign(gear=data.table["gear"] + by))


def _joined(first: LearningSet, second: LearningSet) -> LearningSet:
    """Both data sets as one; raises a ValueError if they have different inputs."""
    if first.names != second.names:
        raise ValueError(f"{len(second.names)} and {len(first.names)} inputs that differ: take the same ones of both")
    return replace(
        first,
        features=np.concatenate([first.features, second.features]),
        table=pd.concat([first.table, second.table], ignore_index=True),
    )


@runtime_checkable
class Representation(Hashable, Protocol):
    """A rule that computes inputs from recordings; equal representations give equal inputs."""

    def learning_set(self, blocks: Iterable[LabelledSignals]) -> LearningSet:
        """Inputs of the samples of a data set, which arrives in one or more blocks."""
        ...


def gear_by_gear(
    blocks: Iterable[LabelledSignals], representation: Representation, folder: Path, progress: Callable[[int], object]
) -> LearningSet:
    """Inputs of a data set that is too large for the memory, computed gear by gear and stored in a file.

    Parameters
    ----------
    blocks : iterable of LabelledSignals
        The recordings of each gear are consecutive.
    representation : Representation
    folder : Path
        Folder of the temporary file, which has no name and is removed with the process.
    progress : callable
        Called with the number of recordings of each finished gear.

    Raises
    ------
    ValueError
        If the recordings of a gear are not consecutive.
    """
    facts: list[LearningSet] = []

    def features() -> Iterator[Float[np.ndarray, "sample feature"]]:
        for recordings in _gears(blocks):
            of_gear = representation.learning_set(recordings)
            facts.append(replace(of_gear, features=np.empty((0, len(of_gear.names)))))
            progress(sum(map(len, recordings)))
            yield np.asarray(of_gear.features)

    rows = on_disk(features(), folder)
    table = pd.concat([each.table for each in facts], ignore_index=True)
    return LearningSet(rows, table, facts[0].names, facts[0].layout)


def _gears(blocks: Iterable[LabelledSignals]) -> Iterator[list[LabelledSignals]]:
    """The recordings of each gear."""
    pieces = (block.where(rows) for block in blocks for rows in _runs(block.table["gear"].to_numpy()))
    finished: set[int] = set()
    for gear, of_gear in groupby(pieces, key=lambda piece: int(piece.table["gear"].iloc[0])):
        if gear in finished:
            raise ValueError(f"recordings of gear {gear} in two places of the data set: they must be consecutive")
        finished.add(gear)
        yield list(of_gear)


def _runs(values: Int[np.ndarray, " row"]) -> list[Int[np.ndarray, " run"]]:
    """Row numbers of each run of equal values."""
    return np.split(np.arange(len(values)), np.flatnonzero(np.diff(values)) + 1)
