"""Evaluation of transfer: a source model for each fold, adapted to every left-out gear with drawn shots."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from learn.adaptation.adapted import Adapted
from learn.adaptation.rezero import Rezero
from learn.adaptation.transfer import Adaptation, Labelled
from learn.inputs.inputs import SPECIMEN, LearningSet
from learn.methods.product import product
from learn.protocols.levels import Episode, Target
from swgsim.common.seeds import seed_hash

SourceModel = Callable[[Any, Any, Any], Any]  # (rows, class names, gears) to a trained model


def adapt_and_judge(
    data: LearningSet,
    episodes: Iterable[Episode],
    source_model: SourceModel,
    adaptation: Adaptation | Rezero,
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
    adaptation : Adaptation or Rezero
    shots : sequence of int
        Numbers K of labelled variants per class; 0 for methods of level Z2, which need one draw. For a :class:`Rezero`
        they are healthy variants.
    draws : int
        Number of draws of the shots; the draws are the same for all methods.
    """
    y, gears = data.table["label"].astype(str).to_numpy(), data.table["gear"].to_numpy()
    unit = data.table.groupby(list(SPECIMEN), observed=True).ngroup().to_numpy()

    def trained(given: LearningSet, rows: np.ndarray) -> Any:
        return source_model(np.asarray(given.features[rows]), y[rows], gears[rows])

    def wrong(model: Any, given: LearningSet, rows: np.ndarray) -> np.ndarray:
        if not len(rows):  # no variants were kept out
            return np.zeros(0, bool)
        return np.asarray(model.predict(given.features[rows]) != y[rows])

    def wrong_units(model: Any, given: LearningSet, rows: np.ndarray) -> np.ndarray:
        together = product(np.asarray(model.predict_proba(given.features[rows])), unit[rows])
        return np.asarray(np.asarray(model.classes_)[together.argmax(axis=1)] != y[rows])

    def adapted(episode: Episode) -> Iterator[Adapted]:
        kept = Labelled(np.asarray(data.features[episode.source]), y[episode.source])
        model = trained(data, episode.source)
        before = wrong(model, data, episode.kept_out)
        of_target = [wrong(model, data, target.judged) for target in episode.targets]
        for number in shots:
            judged: list[list[np.ndarray]] = [[] for _ in episode.targets]
            units: list[list[np.ndarray]] = [[] for _ in episode.targets]
            forgotten: list[list[float]] = [[] for _ in episode.targets]
            for draw in range(draws if number else 1):
                if isinstance(adaptation, Rezero):
                    given, rows = adaptation.rezeroed(data, episode, number, draw)
                    corrected = trained(given, rows)
                for i, target in enumerate(episode.targets):
                    if isinstance(adaptation, Rezero):
                        new, inputs = corrected, given
                    else:
                        new, inputs = _adapted(data, y, model, kept, target, adaptation, number, draw), data
                    judged[i].append(wrong(new, inputs, target.judged))
                    units[i].append(wrong_units(new, inputs, target.judged))
                    forgotten[i].append(_lost(before, wrong(new, inputs, episode.kept_out)))
            for i, target in enumerate(episode.targets):
                yield Adapted.of_gear(data.table, target, number, judged[i], units[i], of_target[i], forgotten[i])

    return Adapted.of([part for episode in episodes for part in adapted(episode)])


def _adapted(
    data: LearningSet, y: np.ndarray, model: Any, kept: Labelled, target: Target, adaptation: Adaptation,
    number: int, draw: int,
) -> Any:  # fmt: skip
    rows = target.shots(data.table, number, draw)
    unlabelled = np.asarray(data.features[target.unlabelled[: 0 if number else None]])
    seed = seed_hash("adaptation", target.gear, number, draw) % 2**31
    return adaptation.adapt(model, kept, Labelled(np.asarray(data.features[rows]), y[rows]), unlabelled, seed)


def _lost(before: np.ndarray, after: np.ndarray) -> float:
    """Loss of accuracy on source gears [points]; NaN without rows."""
    return 100 * float(after.mean() - before.mean()) if len(before) else float("nan")
