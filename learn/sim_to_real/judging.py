"""Train on the recordings that a model makes of a gear, test on those of its bench."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from learn.evaluation.evaluate import evaluate
from learn.inputs.inputs import LearningSet
from learn.jobs import settings
from learn.protocols.splits import Split
from swgsim.storage import storage
from swgsim.storage.labelled_signals import LabelledSignals

MODELS = ("before", "after", "oracle")  # without the effect, with what the loop found, with the true effect
# The day on which the healthy references were recorded: before the effect came, or with it.
COMMISSIONING, SAME_DAY = DAYS = ("commissioning", "same day")


@dataclass(frozen=True)
class Pair:
    """Two data sets of a gear that differ only in what acts on every run.

    Attributes
    ----------
    plain : Path
        Without the effect.
    acting : Path
        With it; the same file if no effect acts.
    """

    plain: Path
    acting: Path

    def blocks(self, day: str) -> Iterator[LabelledSignals]:
        """Samples under the effect, and references of a day.

        Raises
        ------
        ValueError
            If the day is not one of :data:`DAYS`.
        """
        if day not in DAYS:
            raise ValueError(f"unknown day of the references {day!r}; choose from {', '.join(DAYS)}")
        yield storage.read(self.acting).samples
        yield storage.read(self.plain if day == COMMISSIONING else self.acting).references


def judged(models: Mapping[str, Pair], bench: Pair, methods: Mapping[str, Mapping[str, Any]]) -> pd.DataFrame:
    """What every method says of the bench's samples when trained on each model, with references of each day.

    Training and test have references of the same day: whoever has recorded them before the effect came also simulates
    them without it.

    Parameters
    ----------
    models : mapping
        The data sets of each of :data:`MODELS`.
    bench : Pair
    methods : mapping
        Under the name of each method, its ``features`` and its ``classifier`` (conf/features, conf/classifier).

    Returns
    -------
    DataFrame
        ``method``, ``day``, ``model``, and the predictions (:meth:`learn.evaluation.Evaluation.predictions`).
    """
    tables = []
    for name, method in methods.items():
        representation = settings.representation(method["features"])
        for day in DAYS:
            test = representation.learning_set(bench.blocks(day))
            for model in MODELS:
                train = representation.learning_set(models[model].blocks(day))
                make = settings.classifier(method["classifier"], train.layout)
                tables.append(predictions(train, test, make).assign(method=name, day=day, model=model))
    return pd.concat(tables, ignore_index=True)


def predictions(train: LearningSet, test: LearningSet, make: Callable[[], Any]) -> pd.DataFrame:
    """What a classifier that was trained on one set says of all samples of another."""
    count = len(train.table)
    table = pd.concat([train.table, test.table], ignore_index=True)
    split = Split("model->bench", np.arange(count), np.arange(count, len(table)))
    features = np.concatenate([train.features, test.features])
    labels = table["label"].astype(str).to_numpy()
    return evaluate(features, labels, [split], make).predictions(table)
