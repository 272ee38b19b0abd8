"""What of a screening is worth a fit."""

from collections.abc import Iterable, Sequence

import numpy as np

from swgsim.effects.base import Effect
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import unbent
from swgsim.identification.search.hypotheses import Hypothesis, hypotheses, signatures
from swgsim.identification.search.screening import Score, best_of_kind, screen

# Probability of a false effect on recordings in which nothing is missing.
ALPHA = 0.005
# Leaders that are fitted, and those that are as good but for this share of the gain and may be rivals.
LEADERS, NEARLY, NEARLY_LEADERS = 4, 0.05, 8


def screened(fitted: Fitted, kinds: Sequence[type[Effect]], rng: np.random.Generator) -> tuple[Score, ...]:
    """The best hypothesis of every effect that was not added yet."""
    found = offered(fitted, kinds)
    if not found:
        return ()
    fitted = unbent(fitted)
    return tuple(best_of_kind(screen(found, signatures(found, fitted.model, fitted.measured), fitted, rng)))


def offered(fitted: Fitted, kinds: Iterable[type[Effect]]) -> list[Hypothesis]:
    """All hypotheses of the effects that were not added yet."""
    found = hypotheses(kinds, fitted.unit.of_another_structure)
    return [each for each in found if not any(map(each.repeats, fitted.added))]


def leaders(scores: Sequence[Score]) -> list[Score]:
    """What is fitted: the best scores that are no luck, and those hardly worse than the very best."""
    real = [score for score in scores if score.chance <= ALPHA]
    nearly = [s for s in real[LEADERS:NEARLY_LEADERS] if s.gain > (1 - NEARLY) * real[0].gain]
    return [*real[:LEADERS], *nearly]
