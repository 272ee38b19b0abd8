"""Scores of one classifier under one protocol."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from learn.api.choices import choice
from learn.evaluation.confusion import picture
from learn.evaluation.evaluate import Evaluation
from learn.evaluation.evaluate import evaluate as evaluate_splits
from learn.inputs.inputs import LearningSet
from learn.jobs import settings
from learn.methods.classical import Classifier
from swgsim.common.files import write_text
from swgsim.common.style import html_figure


@dataclass(frozen=True, repr=False)
class Scores:
    """What an evaluation gave.

    Attributes
    ----------
    title : str
        Classifier and protocol.
    evaluation : Evaluation
        Scores of every split, confusion matrix and probabilities.
    """

    title: str
    evaluation: Evaluation

    @property
    def test_score(self) -> float:
        """Mean accuracy on the tested sides [%]."""
        return self.evaluation.metrics()["test_score"]

    def table(self) -> pd.DataFrame:
        """One row per split: accuracy on both sides [%] and time to fit [s]."""
        return pd.DataFrame([vars(score) for score in self.evaluation.scores]).set_index("name")

    def plot(self) -> Figure:
        """The confusion matrix of all tested recordings."""
        return picture(self.evaluation, self.title)

    def save(self, path: str | Path) -> None:
        """Write one HTML page with the picture and the table."""
        write_text(Path(path), f"<!doctype html><meta charset=utf-8><title>{self.title}</title>{self._repr_html_()}")

    def __repr__(self) -> str:
        """Title and mean accuracy."""
        return (
            f"<Scores {self.title}: {self.test_score:.1f} % of {len(self.evaluation.tested)} tested recordings right>"
        )

    def _repr_html_(self) -> str:
        return html_figure(self.plot(), repr(self)[1:-1]) + self.table().round(2).to_html()


def evaluate(
    data: LearningSet,
    classifier: str | Callable[[], Classifier] = "rf",
    protocol: str = "random_folds",
    seed: int = 0,
    **options: Any,
) -> Scores:
    """Train on every split of a protocol and test on the other part.

    Parameters
    ----------
    data : LearningSet
        Of :func:`learn.load`.
    classifier : str or callable
        A name of ``conf/classifier``, or a function that makes an untrained classifier of one's own; it has ``fit``,
        ``predict``, ``predict_proba`` and, once trained, ``classes_``.
    protocol : str
        A name of ``conf/protocol``, such as "random_folds" or "leave_one_gear_out".
    seed : int
        Of the folds and of classifiers by name.
    options
        Of a classifier by name, such as ``trees=300``.

    Returns
    -------
    Scores
    """
    splitting = settings.protocol(choice("protocol", protocol, seed))
    if isinstance(classifier, str):
        make = settings.classifier(choice("classifier", classifier, seed, **options), data.layout)
        name = classifier
    else:
        make, name = classifier, getattr(classifier, "__name__", type(classifier).__name__)
    labels = data.table["label"].astype(str).to_numpy()
    splits, gears = splitting.split(data.features, data.table), data.table["gear"].to_numpy()
    evaluation = evaluate_splits(data.features, labels, splits, make, gears)
    return Scores(f"{name}, {protocol.replace('_', ' ')}", evaluation)
