"""A hypothesis fitted with everything else, and what speaks for it."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from swgsim.common.singular import svd
from swgsim.effects.base import Effect
from swgsim.effects.quantity import quantities, size_of
from swgsim.identification.covariance.low_rank_covariance import as_squares
from swgsim.identification.fit.fitted import LIKELIER_BALANCED, Fitted
from swgsim.identification.fit.fitting import extended
from swgsim.identification.fit.form_error import (
    FORM_TOLERANCE,
    LEAST_GAIN,
    Coherence,
    coherence,
    moved_by_forms,
    open_as_found,
    open_form,
    signature,
)
from swgsim.identification.fit.priors import name_of
from swgsim.identification.fit.shape_marginal import over_shapes
from swgsim.identification.search.regularities import Described
from swgsim.identification.search.screening import Score

# Log-likelihood of all recordings that an effect must gain: odds of twenty to one after a search of sixty effects; and
# where left-out operating points do not tell.
LIKELIER, LEAST_EVIDENCE = 7.0, 10.0
# Share to which the chain has the size of an effect right at all: an estimate, of what its mesh makes; of what acts on
# the structure of a gear that has another one, the form tolerance.
EXACT = 0.01
# An effect of which no more than this is left, in standard deviations, is none.
NOTHING = 0.1
# Of what an effect gains in a gear of another structure, this share must be its own, explained by what the library has
# of it. The rest is explained by what is left open for that structure, which fits much else as well (set on benches of
# other authors).
OWN = 1 / 3
# Directions below this share of the largest one are rounding.
LEAST_DIRECTION = 1e-6
STEPS = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class Trial:
    """A hypothesis fitted with everything else.

    Attributes
    ----------
    score : Score
    effects : tuple of Effect
        As fitted.
    fitted : Fitted
        The model with it.
    gains : array (point,)
        Of the log-likelihood of each operating point left out, over a model whose single recordings may err as much;
        the form of the effects is as open as their parts ask for, within the tolerance.
    evidence : float
        Of the log-likelihood of all recordings together, over the same, parameters being open within their spreads; and
        the odds against bridges balanced anew, where the model before needs them. It
        also counts what every operating point shows alike, such as a zero beyond its spread, which the others tell
        already.
    coherence : tuple of Coherence
        Of each effect of the trial.
    beside : tuple of Described
        Regularities beside it that were taken out before its parts agreed.
    imperfect : bool
        Whether its form was open when it was fitted, as what the gear leaves open absorbs it in its own.
    own : float
        Fall of the residual's sum of squares by its effects as the library has them, at any size; asked only where
        another structure leaves much of them open.
    """

    score: Score
    effects: tuple[Effect, ...]
    fitted: Fitted
    gains: Float[np.ndarray, " point"]
    evidence: float
    coherence: tuple[Coherence, ...]
    beside: tuple[Described, ...] = ()
    imperfect: bool = False
    own: float = np.inf

    @property
    def heldout_gain(self) -> float:
        """Of the log-likelihood of all operating points left out; a score's gain is a fall of a sum of squares."""
        return float(self.gains.sum())

    @cached_property
    def signature(self) -> Float[np.ndarray, "row effect"]:
        """What each of its effects does to the features."""
        first = len(self.fitted.model.effects) - len(self.effects)
        return np.stack([signature(self.fitted, first + i) for i in range(len(self.effects))], axis=1)

    @cached_property
    def with_open_form(self) -> Fitted:
        """The fit, with the form of its effects open within the tolerance."""
        return open_form(self.fitted, len(self.effects))

    def explained(self, before: Fitted) -> float:
        """Fall of the residual's sum of squares that it brings to the model before, as a score counts it."""
        return gain(before, self.signature)

    @property
    def sound(self) -> bool:
        """Whether it pays and does not contradict itself."""
        return self.pays and all(each.holds for each in self.coherence)

    @property
    def pays(self) -> bool:
        """Whether its fit came to rest, helps on operating points it was not fitted on, and is likelier altogether than
        that it is not there: the two count different errors of the fit, and the luck of noise is seldom in both. And
        whether it does so as the effect that it is.
        """
        helps = self.evidence > (LIKELIER if self.heldout_gain > LEAST_GAIN else LEAST_EVIDENCE)
        return helps and self.heldout_gain > -LEAST_GAIN and self.fitted.calibrated.settled and not self.disowned

    @property
    def disowned(self) -> bool:
        """Whether too little of what it gains is its own."""
        return self.own < OWN * as_squares(self.evidence)

    @property
    def deviation(self) -> dict[str, float]:
        """Standard deviation of each fitted parameter, by noise, all shapes and an imperfect form."""
        first = len(self.fitted.model.effects) - len(self.effects)
        return widened(self.fitted, first, self.coherence)

    @property
    def there(self) -> bool:
        """Whether it was not fitted down to nothing."""
        return seen(self.fitted, self.signature)

    @property
    def credit(self) -> float:
        """All that it gains, by whatever."""
        return self.heldout_gain + self.evidence

    @property
    def merit(self) -> float:
        """What trials are ordered by; what is not there, or gains by what is not its own, is none."""
        return self.credit if self.there and not self.disowned else -np.inf


def seen(fitted: Fitted, signatures: Float[np.ndarray, "row effect"]) -> bool:
    """Whether more than nothing is left of all effects in a fit."""
    # Beside the errors alone: their own sizes are open too, and against that a small share of a spread is nothing.
    return bool((np.linalg.norm(fitted.errors.whiten(signatures), axis=0) > NOTHING).all())


def tried(now: Fitted, score: Score, added: tuple[Effect, ...], start: Fitted) -> Trial:
    """Effects added to a model and fitted with it.

    Parameters
    ----------
    now : Fitted
        What the gain is counted from.
    score : Score
        Of the first of them.
    added : tuple of Effect
    start : Fitted
        The same model where the fit begins.
    """
    STEPS.info("fitting %s", " with ".join(effect.title() for effect in added))
    known = len(now.model.effects)
    fitted = extended(start, added)
    effects = fitted.model.effects[known:]
    found = tuple(coherence(fitted, known + number) for number in range(len(added)))
    opened = open_as_found(fitted, found)
    without = _as_likely_before(now, opened)
    # Many trials are kept, so without what was computed of them on the way.
    trial = Trial(score, effects, replace(fitted), *_gain_over(without, opened), found)
    return replace(trial, own=trial.explained(without)) if open_to_much(fitted, effects) else trial


def open_to_much(fitted: Fitted, effects: Sequence[Effect]) -> bool:
    """Whether another structure than the model's leaves open much of what the effects do."""
    return fitted.unit.of_another_structure and any(effect.structural for effect in effects)


def gained(now: Fitted, fitted: Fitted) -> tuple[Float[np.ndarray, " point"], float]:
    """Log-likelihood of each operating point left out, and of all together, that a fit gains over the model before."""
    return _gain_over(_as_likely_before(now, fitted), fitted)


def _gain_over(without: Fitted, fitted: Fitted) -> tuple[Float[np.ndarray, " point"], float]:
    """Log-likelihood of each operating point left out, and of all together, that one fit has over another."""
    return fitted.predictive - without.predictive, fitted.log_likelihood - _counted(without, fitted.measured.zeros)


def _counted(fitted: Fitted, zeros: float) -> float:
    """Log-likelihood, less the odds against bridges balanced anew where zeros may lie further off than these."""
    return fitted.log_likelihood - LIKELIER_BALANCED * (fitted.measured.zeros > zeros)


def _as_likely_before(now: Fitted, fitted: Fitted) -> Fitted:
    """The model before a fit, as likely as errors of single recordings and bridges balanced anew make it.

    An effect that makes repeats differ makes the errors of single recordings larger, and these explain much without
    it; so the model before has them as large, if that makes it likelier. What moves the zeros of several gauges,
    bridges that were balanced anew explain too.
    """
    before = (now, now.scattering(fitted.scatter), now.balanced)
    return max(before, key=lambda each: _counted(each, now.measured.zeros))


def widened(fitted: Fitted, first: int, coherences: Sequence[Coherence]) -> dict[str, float]:
    """Standard deviation of each fitted parameter, over all shapes of an effect, and also by what imperfect forms leave
    in doubt of the parameters of effects.

    Parameters
    ----------
    fitted : Fitted
    first : int
        Number of the effect to which the first coherence belongs.
    coherences : sequence of Coherence
    """
    found = dict(fitted.deviation)
    moved = moved_by_forms(fitted, dict(enumerate(coherences, first)))
    for number, agreement in enumerate(coherences, first):
        found |= over_shapes(fitted, number)
        effect = fitted.model.effects[number]
        size = size_of(type(effect))
        by = getattr(effect, size) - quantities(type(effect))[size].nothing
        moved[name_of(effect, number, size)] = float(np.hypot(agreement.doubt, _exact(effect, fitted)) * abs(by))
    return found | {name: float(np.hypot(found[name], doubt)) for name, doubt in moved.items() if ": " in name}


def _exact(effect: Effect, fitted: Fitted) -> float:
    """Share to which the chain has the size of an effect right."""
    return FORM_TOLERANCE if effect.structural and fitted.unit.of_another_structure else EXACT


def gain(fitted: Fitted, directions: Float[np.ndarray, "row direction"]) -> float:
    """Fall of a residual's sum of squares by directions of any size."""
    U, s, _ = svd(fitted.whole.whiten(directions))
    along = U[:, s > LEAST_DIRECTION * max(float(s[0]), LEAST_DIRECTION)].T @ fitted.whole.whiten(fitted.from_start)
    return float(along @ along)
