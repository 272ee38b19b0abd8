"""Choosing hyper-parameters on development gears: the same number of trials for every method, no judged gear seen."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

Options = Mapping[str, Any]


def choose(trials: Sequence[Options], score: Callable[[Options], float]) -> tuple[Options, list[float]]:
    """The options with the highest score, the first of equals, and the scores of all.

    Parameters
    ----------
    trials : sequence of mapping
        A single one is taken without a score.
    score : callable
        Of options, on development gears.
    """
    if len(trials) == 1:
        return trials[0], []
    scores = [score(options) for options in trials]
    return trials[int(np.argmax(scores))], scores


def trial_metrics(scores: Sequence[float]) -> dict[str, float]:
    """The scores of all trials [%] under names that MLflow accepts."""
    return {f"trial/{number}": round(score, 3) for number, score in enumerate(scores, start=1)}
