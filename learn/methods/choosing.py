"""Choice of hyper-parameters on development gears, with equally many trials for every method."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

Options = Mapping[str, Any]


class Choice(NamedTuple):
    """The options of one fold of judged gears, their number among the trials, and the scores of all trials."""

    options: Options
    number: int
    scores: Sequence[float]


CONFIGURED = Choice({}, 0, ())  # nothing to choose


def choose(trials: Sequence[Options], score: Callable[[Options], float]) -> Choice:
    """The options with the highest score, and the scores of all options.

    Parameters
    ----------
    trials : sequence of mapping
        Options to compare. If there is only one, it is chosen without a score.
    score : callable
        Score of options on development gears. The first of equal scores wins.
    """
    if len(trials) == 1:
        return Choice(trials[0], 0, ())
    scores = [score(options) for options in trials]
    best = int(np.argmax(scores))
    return Choice(trials[best], best, scores)


def trial_metrics(choices: Sequence[Choice]) -> dict[str, float]:
    """Mean score of every trial over the folds [%], and the number of the chosen trial of every fold, by metric name.

    >>> trial_metrics([Choice({}, 1, [80.0, 90.0]), Choice({}, 0, [85.0, 84.0])])
    {'trial/1': 82.5, 'trial/2': 87.0, 'chosen/1': 2.0, 'chosen/2': 1.0}
    """
    tried = [choice for choice in choices if choice.scores]
    if not tried:
        return {}
    means = np.mean([choice.scores for choice in tried], axis=0)
    return {
        **{f"trial/{number}": round(float(score), 3) for number, score in enumerate(means, start=1)},
        **{f"chosen/{fold}": choice.number + 1.0 for fold, choice in enumerate(choices, start=1)},
    }
