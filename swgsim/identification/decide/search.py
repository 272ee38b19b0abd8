"""The search for options: it proposes, and the posterior decides.

From the best option, and from the best one without each of its causes, it adds what the score test ranks first, until
no other option is more probable than the best one.
"""

import logging
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from swgsim.chain import NoSteadyState
from swgsim.effects.base import Effect
from swgsim.effects.quantity import quantities
from swgsim.identification.decide.evidence import expected_gain
from swgsim.identification.decide.line_proposals import LineProposals, Proposal
from swgsim.identification.decide.option import Option, causes_of, option, resembling
from swgsim.identification.decide.prior import LOG_SIZE_RANGE, MOST_CAUSES, log_choices, log_prior
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import at_plausible_parameters
from swgsim.identification.fit.form_error import all_show
from swgsim.identification.search.hypotheses import Hypothesis, hypotheses, signatures
from swgsim.identification.search.refining import zoom
from swgsim.identification.search.regularities import Described, describe, other_laws
from swgsim.identification.search.screening import Score, best_of_kind, rank, screen

# Limits of the computing time: effects that are compared without and with a fit from one option, regularities of an
# option, and fits in all.
EFFECTS_LOOKED_AT, EFFECTS_TRIED, MOST_REGULARITIES, MOST_FITS = 15, 5, 3, 20
# An option is fitted if its posterior, as the score test estimates it, is at most so far below the best one [nat].
LOG_POSTERIOR_MARGIN = 3.0
STEPS = logging.getLogger(__name__)


class Search:
    """The options for the recordings of a unit.

    Parameters
    ----------
    null : Fitted
        The model of the unit.
    kinds : sequence of effect classes
        The library.
    """

    def __init__(self, null: Fitted, kinds: Sequence[type[Effect]]) -> None:
        self.null, self.kinds = null, kinds
        self._options: dict[frozenset[object], Option] = {}
        self._expanded: set[frozenset[object]] = set()
        self._fits = 0

    def run(self) -> list[Option]:
        """All options that were fitted, the most probable first."""
        self._fit(self.null, (), ())
        while self._fits < MOST_FITS and (
            fresh := [each for each in self._around_best() if each.causes not in self._expanded]
        ):
            for each in fresh:
                self._expand(each)
        if self._fits >= MOST_FITS:
            STEPS.info("the search ends after %d fits", MOST_FITS)
        alone = [each for each in self._options.values() if not each.regularities]
        more = [like for each in alone for like in resembling(each, len(self.kinds))]
        return sorted([*self._options.values(), *more], key=lambda each: -each.log_posterior)

    def scores(self, rng: np.random.Generator) -> tuple[Score, ...]:
        """The best hypothesis of every effect, with p-values from drawn noise."""
        every, changes = self._library
        STEPS.info("p-values of %d hypotheses", len(every))
        return tuple(best_of_kind(screen(every, changes, at_plausible_parameters(self.null), rng))) if every else ()

    def with_regularities(self, unknown: Option) -> Option:
        """An option with regularities for something unknown that resembles an effect, and with the same effects."""
        alone = causes_of(unknown.effects, ())
        fitted = [each for each in self._options.values() if causes_of(each.effects, ()) == alone]
        fitted = fitted or [option(self.null.with_zeros(unknown.zeros), unknown.effects, (), len(self.kinds))]
        best = max(fitted, key=lambda each: (bool(each.regularities), each.log_posterior))
        while len(best.regularities) < MOST_REGULARITIES:
            opened = best.opened(*best.likeliest)
            more = option(opened, (), (*best.regularities, _strongest(opened)), len(self.kinds))
            if best.regularities and more.log_posterior < best.log_posterior:
                break
            best = more
        return best

    @property
    def _best(self) -> Option:
        return max(self._options.values(), key=lambda each: each.log_posterior)

    def _around_best(self) -> Iterator[Option]:
        """The best option, and the same without each of its causes."""
        best = self._best
        yield best
        if best.lines_differ:  # others may be a pair of causes, neither of which explains much alone
            yield max((o for o in self._options.values() if not o.lines_differ), key=lambda each: each.log_posterior)
        fewer: list[tuple[Sequence[Effect], Sequence[Described]]] = [
            *(([e for e in best.effects if e is not effect], best.regularities) for effect in best.effects),
            *((best.effects, [r for r in best.regularities if r is not each]) for each in best.regularities),
        ]
        for effects, regularities in fewer:
            if found := self._known(best, effects, regularities):
                yield found

    def _known(self, like: Option, effects: Sequence[Effect], regularities: Sequence[Described]) -> Option | None:
        """An option that was fitted, or is fitted now; None if that cannot be."""
        causes = causes_of(effects, regularities)
        if causes not in self._options:
            self._fit(self.null.with_zeros(like.zeros), effects, regularities)
        return self._options.get(causes)

    def _fit(self, start: Fitted, effects: Sequence[Effect], regularities: Sequence[Described]) -> None:
        if self._fits >= MOST_FITS:
            return
        self._fits += 1
        names = [effect.title() for effect in (*start.added, *effects)] + [str(each) for each in regularities]
        STEPS.info("fitting %s", " with ".join(names) or "the model as it is")
        try:
            found = option(start, effects, regularities, len(self.kinds))
        except NoSteadyState:
            STEPS.info("no gear with it turns steadily")
            return
        if not all_show(found.fitted):
            return
        known = self._options.get(found.causes)
        if known is None or found.log_posterior > known.log_posterior:
            self._options[found.causes] = found

    def _expand(self, base: Option) -> None:
        """Fit an option with one more effect, or with one more regularity."""
        self._expanded.add(base.causes)
        causes = len(base.effects) + bool(base.regularities)
        if base.lines_differ:
            return  # what else would be missing cannot be told from the errors of its lines
        # Zeros that may lie far off, and an effect whose form is open, hide the further effect that made them so.
        zeros, form_error = base.likeliest
        for setting in dict.fromkeys(((zeros, form_error), (0, form_error), (zeros, 0))):
            opened, evidence = base.opened(*setting), float(base.evidences[setting])
            start = at_plausible_parameters(opened)
            for gain, score in self._leading(start) if causes < MOST_CAUSES else ():
                if self._promises(base, evidence + gain, effects=1):
                    self._fit(start, (zoom(score, start),), base.regularities)
            if len(base.regularities) < MOST_REGULARITIES and causes + (not base.regularities) <= MOST_CAUSES:
                first = _strongest(opened)
                gain = (first.gain - first.freedom * np.log1p(first.gain / first.freedom)) / 2 - np.log(LOG_SIZE_RANGE)
                if self._promises(base, evidence + gain, regularities=1):
                    self._fit(opened, (), (*base.regularities, first))
        # Last, as the expected evidence of those above is too low beside theirs if nothing explains the recordings.
        if not base.effects and not base.regularities and self.null.unit.of_another_structure:
            for each in self._whose_lines_differ():
                if self._promises(base, each.log_evidence, effects=1):
                    self._fit(each.start, (each.effect,), ())

    def _promises(self, base: Option, log_evidence: float, *, effects: int = 0, regularities: int = 0) -> bool:
        """Whether an option with more causes may be nearly as probable as the best one, by its expected evidence."""
        then = log_prior(len(base.effects) + effects, 0, len(base.regularities) + regularities, len(self.kinds))
        if self._best.fits_badly:
            return bool(then > -np.inf)  # no estimate is worth much beside such a misfit
        return bool(log_evidence + then > self._best.log_posterior - LOG_POSTERIOR_MARGIN)

    def _leading(self, start: Fitted) -> list[tuple[float, Score]]:
        """The best hypotheses of the leading effects that are not in the model, with the expected log evidence."""
        every, changes = self._library
        if any(effect.sharp for effect in start.added):  # beyond its threshold other effects look different
            changes = signatures(every, start.model, start.measured)
        offered = [
            n
            for n, each in enumerate(every)
            if not any(map(each.repeats, start.added)) and not start.unit.opens(each.kind)
        ]
        STEPS.info("screening %d hypotheses", len(offered))
        scores = best_of_kind(rank([every[n] for n in offered], [changes[n] for n in offered], start))
        of_hypothesis = dict(zip(every, changes, strict=True))
        leading = [score for score in scores[:EFFECTS_LOOKED_AT] if np.isfinite(score.estimate)]
        gains = [
            expected_gain(start, estimated(each, of_hypothesis[each.hypothesis])) - log_choices(each.hypothesis.kind)
            for each in leading
        ]
        return sorted(zip(gains, leading, strict=True), key=lambda each: -each[0])[:EFFECTS_TRIED]

    def _whose_lines_differ(self) -> list[Proposal]:
        """The leading effects whose lines differ one by one from the library's."""
        every, changes = self._library
        gauges = self.null.measured.layout.of_gauges.any()
        offered = [n for n, each in enumerate(every) if gauges and self.null.unit.opens(each.kind)]
        STEPS.info("screening %d hypotheses whose lines may differ", len(offered))
        return LineProposals(self.null).leading(
            [every[n] for n in offered], [changes[n] for n in offered], EFFECTS_TRIED
        )

    @cached_property
    def _library(self) -> tuple[list[Hypothesis], list[Float[np.ndarray, "row column"]]]:
        """All hypotheses with their signatures in the model of the unit; other effects hardly change them."""
        start = at_plausible_parameters(self.null)
        every = list(hypotheses(self.kinds, start.unit.of_another_structure))
        return every, signatures(every, start.model, start.measured)


def _strongest(fitted: Fitted) -> Described:
    """The most significant regularity, with the laws that fit as well."""
    first, *others = describe(fitted)
    return replace(first, rivals=other_laws(first, others))


def estimated(score: Score, signature: Float[np.ndarray, "row column"]) -> Float[np.ndarray, " row"]:
    """What an effect changes at the estimate of its score."""
    nothing = quantities(score.hypothesis.kind)[score.hypothesis.size].nothing
    of_phase = np.array([np.cos(score.phase), np.sin(score.phase)])[: signature.shape[1]]
    return signature @ of_phase * (score.estimate - nothing) / (score.hypothesis.typical - nothing)
