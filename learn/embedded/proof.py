"""An exported method beside its original, on the recordings of the gear that it was exported for."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from learn.embedded.machines import Machine, build
from learn.embedded.running import Decisions, decide
from swgsim.storage.labelled_signals import LabelledSignals

FACTS = ["n_in_rpm", "T_out_nm", "efficiency", "temperature_c"]

FAITHFUL = 99.5  # labels as in Python, at least [%]


@dataclass(frozen=True)
class Agreement:
    """How an exported method agrees with its original.

    Attributes
    ----------
    recordings, decided, equal : int
        How many there were, on how many there was a decision, and on how many it was that of the original.
    difference : float
        Largest one of a probability.
    """

    recordings: int
    decided: int
    equal: int
    difference: float

    @property
    def share(self) -> float:
        """Labels that are those of the original [%]."""
        return 100 * self.equal / self.recordings

    def __str__(self) -> str:
        return (
            f"{self.equal} of {self.recordings} labels as in Python ({self.recordings - self.decided} without a "
            f"decision), probabilities within {self.difference:.1e}"
        )


def agreement(said: Decisions, probabilities: Float[np.ndarray, "recording class"]) -> Agreement:
    """Decisions beside the probabilities that the original gives."""
    decided = said.results >= 0
    difference = np.abs(said.probabilities - probabilities)[decided]
    equal = said.results == probabilities.argmax(axis=1)
    return Agreement(len(equal), int(decided.sum()), int(equal.sum()), float(difference.max(initial=0)))


def together(parts: Sequence[Agreement]) -> Agreement:
    """That of several sets of recordings."""
    return Agreement(
        sum(part.recordings for part in parts),
        sum(part.decided for part in parts),
        sum(part.equal for part in parts),
        max(part.difference for part in parts),
    )


def said_by(folder: Path, machine: Machine, recordings: LabelledSignals) -> Decisions:
    """What an exported method says of recordings on a machine."""
    with TemporaryDirectory(prefix="swg-") as out:
        return decide(build(folder, machine, Path(out)), machine, recordings.signals, operations(recordings.table))


def operations(table: pd.DataFrame) -> Float[np.ndarray, "recording quantity"]:
    """What the drive knows beside the gauges, of :data:`learn.embedded.running.OPERATION`."""
    return table[FACTS].to_numpy(dtype=float)


def prove(folder: Path, machine: Machine, model: Any, features: np.ndarray, recordings: LabelledSignals) -> Agreement:
    """Run an exported method on a gear's recordings, whose features the original is given."""
    return agreement(said_by(folder, machine, recordings), model.predict_proba(features))
