"""Screening of the library, and the shortlist of effects that are fitted."""

import logging
from collections.abc import Sequence

import numpy as np

from swgsim.effects.base import Effect
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import at_plausible_parameters
from swgsim.identification.search.hypotheses import hypotheses, signatures
from swgsim.identification.search.screening import Score, best_of_kind, screen

# Probability of a false effect on recordings in which nothing is missing.
ALPHA = 0.005
STEPS = logging.getLogger(__name__)


def screened(fitted: Fitted, kinds: Sequence[type[Effect]], rng: np.random.Generator) -> tuple[Score, ...]:
    """The best hypothesis of every effect that is not in the model yet."""
    every = hypotheses(kinds, fitted.unit.of_another_structure)
    found = [each for each in every if not any(map(each.repeats, fitted.added))]
    if not found:
        return ()
    STEPS.info("screening %d hypotheses, %d effects in the model", len(found), len(fitted.added))
    fitted = at_plausible_parameters(fitted)
    return tuple(best_of_kind(screen(found, signatures(found, fitted.model, fitted.measured), fitted, rng)))
