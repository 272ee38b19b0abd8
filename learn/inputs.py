"""What every method is given: one row of numbers per recording, and the facts beside it."""

from collections.abc import Hashable, Iterable
from dataclasses import dataclass
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
import pandas as pd
from jaxtyping import Float

from swgsim.recordings import Recordings

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
    table : DataFrame
        One row of facts per sample, with the columns of :data:`swgsim.recordings.COLUMNS`.
    names : tuple of str
        One per feature.
    layout : Layout
        Which columns are a signal; methods that know no signals take all columns alike.
    """

    features: Float[np.ndarray, "sample feature"]
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

    def learning_set(self, blocks: Iterable[Recordings]) -> LearningSet:
        """The inputs of the samples of a data set, which comes in one block or in many that are dropped one by one."""
        ...
