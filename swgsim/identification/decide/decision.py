"""The decision: the posterior over options, and the model with the most probable one."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import logsumexp

from swgsim.common.seeds import generator
from swgsim.effects.base import Effect
from swgsim.effects.quantity import beyond_nothing, size_of
from swgsim.identification.data.measured import Measured
from swgsim.identification.decide.option import Option, causes_of, kind_of
from swgsim.identification.decide.search import Search
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import at_plausible_parameters, extended, fit
from swgsim.identification.fit.form_error import moved_by_forms
from swgsim.identification.fit.priors import name_of
from swgsim.identification.fit.shape_marginal import over_shapes
from swgsim.identification.fit.unit import Unit
from swgsim.identification.search.detection_limit import at_sizes_seen
from swgsim.identification.search.screening import Score

# Probability of the set of options that the report shows.
CREDIBLE = 0.95
# Share to which the chain has the size of an effect right: an estimate, from the mesh of the truss.
EXACT = 0.01


@dataclass(frozen=True, eq=False)
class Decision:
    """What the model lacks, with probabilities.

    Attributes
    ----------
    before : Fitted
        The model of the unit.
    after : Fitted
        The model with the effects and regularities of the best option.
    best : Option
        The most probable option of the most probable answer; something unknown is described by regularities in it.
    weighed : tuple of (Option, float)
        All options with their probabilities, the most probable first.
    answers : tuple of (Option, float)
        The best option of every answer with the probability of the answer, the most probable first.
    scores : tuple of Score
        Of the first screening, best hypothesis of each effect, with p-values.
    """

    before: Fitted
    after: Fitted
    best: Option
    weighed: tuple[tuple[Option, float], ...]
    answers: tuple[tuple[Option, float], ...]
    scores: tuple[Score, ...]

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The effects of the best option, as fitted in :attr:`after`."""
        return self.after.added[: len(self.best.effects)]

    @property
    def probability(self) -> float:
        """Of the answer: of all options that agree in their effects and in whether something unknown is missing."""
        return self.answers[0][1]

    @property
    def credible(self) -> tuple[tuple[Option, float], ...]:
        """The fewest answers that have a probability of 95 % together."""
        totals = np.cumsum([probability for _, probability in self.answers])
        return self.answers[: int(np.searchsorted(totals, CREDIBLE)) + 1]

    def probability_of(self, effect: Effect) -> float:
        """Probability that an effect of this kind is missing."""
        return float(sum(p for each, p in self.weighed if kind_of(effect) in map(kind_of, each.effects)))

    def gain_of(self, effect: Effect) -> float:
        """Log evidence of the most probable option over the best one without effects of this kind."""
        kind = kind_of(effect)
        others = [o.log_evidence for o, _ in self.weighed if kind not in map(kind_of, (*o.effects, *o.resembled))]
        return self.answers[0][0].log_evidence - max(others, default=-np.inf)

    @cached_property
    def deviation(self) -> dict[str, float]:
        """Standard deviation of each fitted parameter, by noise, all shapes and the form error."""
        fitted = self.after
        found = dict(fitted.deviation)
        numbers = fitted.numbers_added[: len(self.best.effects)]
        if self.best.lines_differ:
            # Errors of its lines are known as far as the recordings tell them, so that size and place are as well.
            opened = self.best.opened(*self.best.likeliest)
            moved = opened.deviation_under(opened.of_nuisances)
            return found | {name: by for name, by in moved.items() if ": " in name}
        moved = moved_by_forms(fitted, dict.fromkeys(numbers, self.best.form_error))
        for number in numbers:
            found |= over_shapes(fitted, number)
            effect = fitted.model.effects[number]
            name = name_of(effect, number, size_of(type(effect)))
            moved[name] = float(np.hypot(moved[name], EXACT * abs(beyond_nothing(effect))))
        return found | {name: float(np.hypot(found[name], by)) for name, by in moved.items() if ": " in name}


def decide(measured: Measured, unit: Unit, kinds: Sequence[type[Effect]], *, seed: int = 0) -> Decision:
    """Find what the model of a unit lacks.

    Parameters
    ----------
    measured : Measured
    unit : Unit
    kinds : sequence of effect classes
        The library.
    seed : int
        Of the simulated noise from which p-values of the scores are computed.
    """
    first = fit(measured, unit)
    search = Search(first, kinds)
    options = search.run()
    weights = np.array([each.log_posterior for each in options])
    weighed = tuple(zip(options, np.exp(weights - logsumexp(weights)).tolist(), strict=True))
    answers = _answers(weighed)
    best, _ = answers[0]
    if best.resembled:
        best = search.with_regularities(best)
    before = first.with_zeros(best.zeros)
    scores = at_sizes_seen(search.scores(generator("screen", seed, 0)), at_plausible_parameters(first))
    return Decision(before, _with(best), best, weighed, answers, scores)


def _with(best: Option) -> Fitted:
    """The model with an option, its regularities being effects too."""
    fitted = best.fitted.with_zeros(best.zeros).strict
    regular = [each.effect for each in best.regularities]
    return extended(fitted, regular) if regular else fitted


def _answers(weighed: Sequence[tuple[Option, float]]) -> tuple[tuple[Option, float], ...]:
    """Options that agree in their effects and in whether something unknown is missing are one answer."""
    found: dict[object, tuple[Option, float]] = {}
    for each, probability in weighed:
        answer = causes_of(each.effects, ()), each.unknown
        first, total = found.get(answer, (each, 0.0))
        found[answer] = first, total + probability
    return tuple(sorted(found.values(), key=lambda each: -each[1]))
