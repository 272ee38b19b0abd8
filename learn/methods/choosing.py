"""Choice of hyper-parameters on development gears, with equally many trials for every method."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

Options = Mapping[str, Any]


def choose(trials: Sequence[Options], score: Callable[[Options], float]) -> tuple[Options, list[float]]:
    """The options with the highest score, and the scores of all options.

    Parameters
    ----------
    trials : sequence of mapping
        Options to compare. If there is only one, it is chosen without a score.
    score : callable
        Score of options on development gears. The first of equal scores wins.
    """
    if len(trials) == 1:
        return trials[0], []
    scores = [score(options) for options in trials]
    return trials[int(np.argmax(scores))], scores


def trial_metrics(scores: Sequence[float]) -> dict[str, float]:
    """Scores of all trials [%] with the names of their metrics."""
    return {f"trial/{number}": round(score, 3) for number, score in enumerate(scores, start=1)}
