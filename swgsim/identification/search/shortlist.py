"""Screening of the library, and the shortlist of effects that are fitted."""

import logging
from collections.abc import Iterable, Sequence

import numpy as np

from swgsim.effects.base import Effect
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import unbent
from swgsim.identification.search.hypotheses import Hypothesis, hypotheses, signatures
from swgsim.identification.search.screening import Score, best_of_kind, screen

# Probability of a false effect on recordings in which nothing is missing.
ALPHA = 0.005
STEPS = logging.getLogger(__name__)


def screened(fitted: Fitted, kinds: Sequence[type[Effect]], rng: np.random.Generator) -> tuple[Score, ...]:
    """The best hypothesis of every effect that is not in the model yet."""
    found = offered(fitted, kinds)
    if not found:
        return ()
    STEPS.info("screening %d hypotheses, %d effects in the model", len(found), len(fitted.added))
    fitted = unbent(fitted)
    return tuple(best_of_kind(screen(found, signatures(found, fitted.model, fitted.measured), fitted, rng)))


def offered(fitted: Fitted, kinds: Iterable[type[Effect]]) -> list[Hypothesis]:
    """All hypotheses of the effects that are not in the model yet."""
    found = hypotheses(kinds, fitted.unit.of_another_structure)
    return [each for each in found if not any(map(each.repeats, fitted.added))]
