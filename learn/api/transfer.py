"""Transfer to gears never seen, with a few labelled recordings of each."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from learn.adaptation.adapted import Adapted
from learn.adaptation.adapting import adapt_and_judge
from learn.api.choices import choice
from learn.evaluation.evaluate import fit
from learn.inputs.inputs import LearningSet
from learn.jobs import settings
from learn.methods.contract import Classifier
from learn.protocols.levels import NewGears
from swgsim.common.style import html_figure, label


@dataclass(frozen=True, repr=False)
class Transfer:
    """Errors of a classifier on gears never seen, before and after adaptation.

    Attributes
    ----------
    title : str
        Classifier and adaptation.
    adapted : Adapted
        Errors of every specimen and gear.
    """

    title: str
    adapted: Adapted

    def table(self) -> pd.DataFrame:
        """One row per number of shots: mean error over the gears with and without adaptation [%]."""
        return self.adapted.gears.groupby("shots")[["unadapted", "error"]].mean()

    def plot(self) -> Figure:
        """Error over the number of shots, one thin line per gear."""
        figure = Figure(figsize=(6.0, 3.8), layout="constrained")
        axes = figure.add_subplot()
        for _, gear in self.adapted.gears.groupby("gear"):
            axes.plot(gear["shots"], gear["error"], color="#bbbbbb", linewidth=0.8)
        means = self.table()
        axes.plot(means.index, means["unadapted"], "--", color="#000000", label="without adaptation")
        axes.plot(means.index, means["error"], "o-", color="#0072B2", label="adapted, mean over gears")
        axes.legend()
        label(axes, "labelled variants of each class (shots)", "error on the new gear [%]", self.title)
        return figure

    def __repr__(self) -> str:
        """Title and mean error for each number of shots."""
        errors = ", ".join(f"{error:.1f} % with {shots}" for shots, error in self.table()["error"].items())
        return f"<Transfer {self.title}: error {errors} shots>"

    def _repr_html_(self) -> str:
        return html_figure(self.plot(), self.title) + self.table().round(2).to_html()


def transfer(
    data: LearningSet,
    classifier: str = "extra_trees",
    adaptation: str = "added_trees",
    shots: Sequence[int] = (1, 2, 5),
    draws: int = 1,
    folds: int = 5,
    seed: int = 0,
    **options: Any,
) -> Transfer:
    """Leave every gear out in turn, adapt a classifier of the others to it, and judge.

    Parameters
    ----------
    data : LearningSet
        Of several gears.
    classifier, adaptation : str
        Names of ``conf/classifier`` and ``conf/adaptation``.
    shots : sequence of int
        Numbers of labelled variants of each class that the adaptation is given.
    draws : int
        Draws of the shots.
    folds : int
        Parts that the gears are left out in.
    seed : int
    options
        Of the classifier, in place of those of its file.
    """
    levels = {"development": 0, "labelled": max(shots), "unlabelled": 1, "kept_out": 0}
    protocol = settings.protocol(choice("protocol", "new_gears", seed, folds=folds, **levels))
    if not isinstance(protocol, NewGears):
        raise TypeError(f"conf/protocol/new_gears.yaml makes a {type(protocol).__name__}, expected NewGears")
    make = settings.classifier(choice("classifier", classifier, seed, **options), data.layout)
    change = settings.adaptation(choice("adaptation", adaptation, seed))()
    episodes = protocol.episodes(data.table)

    def source_model(X: np.ndarray, y: np.ndarray, gears: np.ndarray) -> Classifier:
        model = make()
        fit(model, X, y, gears)
        return model

    judged = adapt_and_judge(data, episodes, source_model, change, list(shots), draws)
    return Transfer(f"{classifier}, {adaptation.replace('_', ' ')}", judged)
