"""Evaluation of transfer: a source model for each fold, adapted to every left-out gear with drawn shots."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from learn.adaptation.transfer import Adaptation, Labelled
from learn.inputs.inputs import SPECIMEN, LearningSet
from learn.protocols.levels import Episode, Target
from swgsim.common.seeds import seed_hash

SourceModel = Callable[[Any, Any, Any], Any]  # (rows, class names, gears) to a trained model


@dataclass(frozen=True)
class Adapted:
    """Errors of adapted models.

    Attributes
    ----------
    specimens : DataFrame
        ``gear``, ``label``, ``variant``, ``shots``; ``error``, share of wrong decisions over operating points and draws
        [%]; ``unadapted``, the same of the source model [%].
    gears : DataFrame
        ``gear``, ``shots``; ``error`` and ``unadapted`` as above [%]; ``forgotten``, loss of accuracy on source gears
        by the adaptation [points].
    """

    specimens: pd.DataFrame
    gears: pd.DataFrame

    @classmethod
    def of(cls, parts: Sequence["Adapted"]) -> "Adapted":
        """The errors of several parts, each of other gears."""
        specimens, gears = ([getattr(part, name) for part in parts] for name in ("specimens", "gears"))
        return cls(pd.concat(specimens, ignore_index=True), pd.concat(gears, ignore_index=True))

    def mean_error(self) -> float:
        """Mean over gears and numbers of shots [%]."""
        return float(self.gears["error"].mean())

    def metrics(self) -> dict[str, float]:
        """Means over gears for each number of shots, rounded to three decimals, by metric name."""
        means = self.gears.groupby("shots")[["error", "unadapted", "forgotten"]].mean()
        each = {f"{name}/{shots}_shots": value for name, column in means.items() for shots, value in column.items()}
        return {name: round(value, 3) for name, value in {"test_score": 100 - self.mean_error(), **each}.items()}


def adapt_and_judge(
    data: LearningSet,
    episodes: Iterable[Episode],
    source_model: SourceModel,
    adaptation: Adaptation,
    shots: Sequence[int],
    draws: int,
) -> Adapted:
    """Adapt to every target of every episode for each number and draw of shots, and evaluate.

    Parameters
    ----------
    data : LearningSet
    episodes : iterable of Episode
    source_model : callable
        Trains a model on rows, class names and the gear of every row.
    adaptation : Adaptation
    shots : sequence of int
        Numbers K of labelled variants per class; 0 for methods of level Z2, which need one draw.
    draws : int
        Number of draws of the shots; the draws are the same for all methods.
    """
    y = data.table["label"].astype(str).to_numpy()
    specimens, gears = [], []
    for episode in episodes:
        kept = Labelled(np.asarray(data.features[episode.source]), y[episode.source])
        model = source_model(*kept, data.table["gear"].to_numpy()[episode.source])
        before = _accuracy(model, data, y, episode.kept_out)
        for target in episode.targets:
            unadapted = 100.0 * (model.predict(data.features[target.judged]) != y[target.judged])
            for number in shots:
                judged, forgotten = [], []
                for draw in range(draws if number else 1):
                    adapted = _adapted(data, y, model, kept, target, adaptation, number, draw)
                    judged.append(adapted.predict(data.features[target.judged]) != y[target.judged])
                    forgotten.append(before - _accuracy(adapted, data, y, episode.kept_out))
                error = 100 * np.mean(judged, axis=0)
                facts = data.table.iloc[target.judged][list(SPECIMEN)]
                specimens.append(facts.assign(label=y[target.judged], shots=number, error=error, unadapted=unadapted))
                gears.append((target.gear, number, error.mean(), unadapted.mean(), float(np.mean(forgotten))))
    each = pd.concat(specimens).groupby([*SPECIMEN, "shots"])[["error", "unadapted"]].mean()
    names = ["gear", "shots", "error", "unadapted", "forgotten"]
    return Adapted(each.reset_index(), pd.DataFrame(gears, columns=names))


def _adapted(
    data: LearningSet, y: np.ndarray, model: Any, kept: Labelled, target: Target, adaptation: Adaptation,
    number: int, draw: int,
) -> Any:  # fmt: skip
    rows = target.shots(data.table, number, draw)
    unlabelled = np.asarray(data.features[target.unlabelled[: 0 if number else None]])
    seed = seed_hash("adaptation", target.gear, number, draw) % 2**31
    return adaptation.adapt(model, kept, Labelled(np.asarray(data.features[rows]), y[rows]), unlabelled, seed)


def _accuracy(model: Any, data: LearningSet, y: np.ndarray, rows: np.ndarray) -> float:
    """Share of correct decisions [%]; NaN without rows."""
    return 100 * float(np.mean(model.predict(data.features[rows]) == y[rows])) if len(rows) else float("nan")
