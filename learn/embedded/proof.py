"""Compares an exported method with its original, on recordings of the gear of the export."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

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
        Numbers of recordings, of those with a decision, and of those with the decision of the original.
    difference : float
        Largest difference of a probability.
    """

    recordings: int
    decided: int
    equal: int
    difference: float

    @property
    def share(self) -> float:
        """Share of labels that equal those of the original [%]."""
        return 100 * self.equal / self.recordings

    def __str__(self) -> str:
        return (
            f"{self.equal} of {self.recordings} labels as in Python ({self.recordings - self.decided} without a "
            f"decision), probabilities within {self.difference:.1e}"
        )


def agreement(decisions: Decisions, probabilities: Float[np.ndarray, "recording class"]) -> Agreement:
    """Agreement of decisions with the probabilities of the original."""
    decided = decisions.results >= 0
    difference = np.abs(decisions.probabilities - probabilities)[decided]
    equal = decisions.results == probabilities.argmax(axis=1)
    return Agreement(len(equal), int(decided.sum()), int(equal.sum()), float(difference.max(initial=0)))


def combined(parts: Sequence[Agreement]) -> Agreement:
    """Agreement over several sets of recordings."""
    return Agreement(
        sum(part.recordings for part in parts),
        sum(part.decided for part in parts),
        sum(part.equal for part in parts),
        max(part.difference for part in parts),
    )


def decisions_of(folder: Path, machine: Machine, recordings: LabelledSignals) -> Decisions:
    """Decisions of an exported method on a machine."""
    with TemporaryDirectory(prefix="swg-") as out:
        return decide(build(folder, machine, Path(out)), machine, recordings.signals, operations(recordings.table))


def operations(table: pd.DataFrame) -> Float[np.ndarray, "recording quantity"]:
    """Quantities that the drive measures, :data:`learn.embedded.running.OPERATION`."""
    return table[FACTS].to_numpy(dtype=float)
