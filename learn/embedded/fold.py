"""A trained classifier with recordings of unseen gears, and the accuracy of its exported code on them."""

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from learn.embedded.export import export_c
from learn.embedded.machines import HOST
from learn.embedded.proof import Agreement, agreement, combined, decisions_of
from learn.evaluation.evaluate import fit
from learn.inputs.inputs import SPECIMEN, Layout, Representation
from learn.jobs.train_job import BLOCK, learning_set_of
from learn.protocols.splits import Splitting
from swgsim.common.checks import require_known
from swgsim.storage import storage
from swgsim.storage.labelled_signals import LabelledSignals


@dataclass(frozen=True)
class Fold:
    """A trained classifier and its test recordings.

    Attributes
    ----------
    model : classifier
        Trained.
    representation : Representation
        Its inputs.
    recordings : LabelledSignals
        References and test samples of gears that are not in the training set.
    features : array (sample, column)
        Its inputs from these samples, computed in Python.
    """

    model: Any
    representation: Representation
    recordings: LabelledSignals
    features: Float[np.ndarray, "sample column"]

    @property
    def gears(self) -> list[int]:
        """Numbers of the gears."""
        return sorted(int(gear) for gear in self.recordings.table["gear"].unique())

    def of_gear(self, gear: int) -> "Fold":
        """The same classifier with the recordings of one gear only."""
        table = self.recordings.table
        mine = (table["gear"] == gear).to_numpy()
        samples = mine[~table["reference"].to_numpy()]
        return replace(self, recordings=self.recordings.where(mine), features=self.features[samples])

    def export(self, folder: Path, numbers: str) -> None:
        """Write its C code for the only gear of the recordings."""
        export_c(self.model, self.representation, self.recordings.references, folder, numbers=numbers)


def folds(
    path: Path, splitting: Splitting, representation: Representation, make: Callable[[Layout], Any]
) -> Iterator[Fold]:
    """The folds of a data set.

    Parameters
    ----------
    path : Path
        The data set.
    splitting : Splitting
        Its test rows are of gears that are in no training row.
    representation : Representation
    make : callable
        Makes an untrained classifier for rows of a layout.
    """
    data = learning_set_of(path, storage.digest(path), representation)
    gear, label = data.table["gear"].to_numpy(), data.table["label"].astype(str).to_numpy()
    for split in splitting.split(data.features, data.table):
        model = make(data.layout)
        fit(model, np.asarray(data.features[split.train]), label[split.train], gear[split.train])
        tested = np.unique(gear[split.test])
        recordings = of_gears(path, tested.tolist())
        kept = recordings.table["reference"].to_numpy().copy()
        kept[~kept] = np.isin(np.flatnonzero(np.isin(gear, tested)), split.test)
        yield Fold(model, representation, recordings.where(kept), np.asarray(data.features[split.test]))


def of_gears(path: Path, gears: Collection[int]) -> LabelledSignals:
    """The recordings of some gears of a data set.

    Raises
    ------
    ValueError
        If one of them is not in it.
    """
    parts = [block.where(block.table["gear"].isin(list(gears))) for block in storage.blocks(path, BLOCK)]
    table = pd.concat([part.table for part in parts], ignore_index=True)
    require_known(f"gears of {path}", map(str, gears), map(str, table["gear"].unique()))
    return replace(parts[0], signals=np.concatenate([part.signals for part in parts]), table=table)


def judged(fold: Fold, numbers: str) -> tuple[pd.DataFrame, Agreement]:
    """Errors of the code on this machine, exported for each gear in turn.

    Returns
    -------
    DataFrame
        The specimen of each recording, and ``error`` [%]: 100 where the class is wrong or there is no decision.
    Agreement
        Of the code with the classifier in Python.
    """
    errors, agreements = [], []
    for gear in fold.gears:
        part = fold.of_gear(gear)
        samples = part.recordings.samples
        with TemporaryDirectory(prefix="swg-") as folder:
            part.export(Path(folder) / "c", numbers)
            decisions = decisions_of(Path(folder) / "c", HOST, samples)
        names = np.append(fold.model.classes_, "no decision")[decisions.results.clip(min=-1)]
        wrong = names != samples.table["label"].astype(str).to_numpy()
        errors.append(samples.table[list(SPECIMEN)].assign(error=100.0 * wrong))
        agreements.append(agreement(decisions, fold.model.predict_proba(part.features)))
    return pd.concat(errors, ignore_index=True), combined(agreements)
