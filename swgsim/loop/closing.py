"""Closing the loop: ask, add, and ask again; then ask for each effect once more with all the others in the model."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from typing import NamedTuple

import numpy as np

from swgsim.effects.base import Effect
from swgsim.loop.asking import Round, ask, ask_behind
from swgsim.loop.evidence import Coherence, coherence, doubt_by_others, signature
from swgsim.loop.fitting import Fitted, extended, fit
from swgsim.loop.leading import screened
from swgsim.loop.screening import Score
from swgsim.loop.session import Measured
from swgsim.loop.steps import Step, cancelling, contradicted, joined, what, with_rivals
from swgsim.loop.trial import Trial, seen, widened
from swgsim.loop.unit import Unit
from swgsim.loop.vocabulary import Described, freed, left, set_free
from swgsim.seeds import generator

# Effects that are added at most.
MOST = 3
# Times that an effect is asked again with all the others in the model, at most.
MOST_AGAIN = 6


@dataclass(frozen=True, eq=False)
class Closed:
    """What closing the loop found.

    Attributes
    ----------
    before, after : Fitted
        The model without and with what was found; all effects were fitted together, if that came to rest.
    asked : Fitted
        The model of the last asking, with the form of what was found open within the tolerance: of what this leaves it
        is asked what more is missing.
    steps : tuple of Step
    scores : tuple of Score
        Of the first screening, best hypothesis of each effect.
    left : tuple of Score
        Of the last screening.
    rejected : tuple of Trial
        Significant, but of the wrong form: they contradict themselves, cancel one another, a bare regularity explains
        more, or they act only where one was set apart.
    outdone_by : Described or None
        That regularity.
    apart : tuple of Described
        Disturbances of single channels that were set apart before an effect was found behind them.
    withdrawn : tuple of Trial
        Accepted at first, and another one, or nothing, in its place once the others were in the model.
    cancelling : tuple of Trial
        Accepted, until they were seen to cancel one another; they are among the rejected.
    """

    before: Fitted
    after: Fitted
    asked: Fitted
    steps: tuple[Step, ...]
    scores: tuple[Score, ...]
    left: tuple[Score, ...]
    rejected: tuple[Trial, ...]
    outdone_by: Described | None
    apart: tuple[Described, ...] = ()
    withdrawn: tuple[Trial, ...] = ()
    cancelling: tuple[Trial, ...] = ()

    @property
    def nearest(self) -> Trial | None:
        """Of what was rejected: the trial that came nearest."""
        return self.rejected[0] if self.rejected and np.isfinite(self.rejected[0].merit) else None

    @cached_property
    def coherence(self) -> tuple[Coherence, ...]:
        """How well the parts of each effect agree once all that was found is in the model.

        When one was accepted, those that were found later still passed for an imperfect form of it. An imperfect form
        of one leaves the sizes of the others in doubt too.
        """
        first, after = len(self.before.model.effects), self._beside_what_is_apart
        beside = [step.accepted.beside for step in self.steps for _ in step.accepted.effects]
        found = {n: coherence(reduce(set_free, each, after), n) for n, each in enumerate(beside, first)}
        by_others = (doubt_by_others(after, n, {m: c for m, c in found.items() if m != n}) for n in found)
        return tuple(
            replace(each, doubt=float(np.hypot(each.doubt, more)))
            for each, more in zip(found.values(), by_others, strict=True)
        )

    @cached_property
    def deviation(self) -> dict[str, float]:
        """Standard deviation of each fitted parameter, by noise, all shapes and the imperfect form of all effects."""
        return widened(self._beside_what_is_apart, len(self.before.model.effects), self.coherence)

    @property
    def _beside_what_is_apart(self) -> Fitted:
        """The model with what was found, what was set apart being free as when that was fitted."""
        return reduce(set_free, self.apart, self.after)


class End(NamedTuple):
    """Where asking came to its end.

    Attributes
    ----------
    now : Fitted
        With what was found, its form open within the tolerance.
    steps : tuple of Step
    apart : tuple of Described
        What was set apart.
    scores : tuple of tuple of Score
        Of each screening.
    last : Round
        What the last asking gave; what was put off, where that came after it.
    """

    now: Fitted
    steps: tuple[Step, ...]
    apart: tuple[Described, ...]
    scores: tuple[tuple[Score, ...], ...]
    last: Round


def close(measured: Measured, unit: Unit, kinds: Sequence[type[Effect]], *, seed: int = 0) -> Closed:
    """Find what the model of a unit lacks.

    Parameters
    ----------
    measured : Measured
    unit : Unit
    kinds : sequence of effect classes
        The library.
    seed : int
    """
    before = fit(measured, unit)
    end = forward = _forward(before, (), (), kinds, seed)
    if len(forward.steps) > 1:
        base = reduce(set_free, forward.apart, before)
        revised = _backward(base, forward.steps, forward.apart, kinds, seed)
        if [what([step]) for step in revised] == [what([step]) for step in forward.steps]:
            end = forward._replace(steps=revised)
        elif (together := joined(base, revised)).calibrated.settled:
            end = _forward(together, revised, forward.apart, kinds, seed)
    if cancelled := cancelling(end.steps, end.now):
        end = _without(cancelled, end, before, kinds, seed)
    found, after = what(end.steps), end.scores[-1]
    unknown = left(end.now, seed, 1) if any(map(contradicted, end.steps)) else ()
    steps = tuple(with_rivals(step, after, found, unknown) for step in end.steps)
    withdrawn = tuple(step.accepted for step in forward.steps if not what([step]) <= found | what(cancelled))
    return Closed(
        before, _together(end), end.now, steps, forward.scores[0], after, end.last.trials, end.last.outdone_by,
        end.apart, withdrawn, tuple(step.accepted for step in cancelled),
    )  # fmt: skip


def _together(end: End) -> Fitted:
    """The model with all that was found, fitted once more with nothing of its form open.

    The size of an effect whose form was open when the next one was added is that of the parts that this leaves alone;
    the interval of a size is of a fit to all of them.
    """
    if len(end.steps) < 2:
        return end.now.strict  # fitted like that
    fitted = extended(reduce(set_free, end.apart, end.now.strict), ())
    numbers = range(len(fitted.unit.model.effects), len(fitted.model.effects))
    stayed = all(seen(fitted, signature(fitted, number)[:, None]) for number in numbers)
    return (fitted if fitted.calibrated.settled and stayed else end.now).strict


def _forward(
    now: Fitted, steps: tuple[Step, ...], apart: tuple[Described, ...], kinds: Sequence[type[Effect]], seed: int
) -> End:
    """Add what is accepted until nothing more is."""
    scores: tuple[tuple[Score, ...], ...] = ()
    while True:
        number = len(steps)
        scores = (*scores, screened(now, kinds, generator("screen", seed, number)))
        found = ask(now, scores[-1] if number < MOST else (), kinds, seed, apart)
        if found.trials and not found.accepted:
            found, apart = ask_behind(now, found, kinds, seed, number, apart)
        if found.accepted is None:
            return End(now, steps, apart, scores, found)
        steps = (*steps, Step(found.accepted, (), found.others))
        now = found.accepted.with_open_form


def _without(cancelled: Sequence[Step], end: End, before: Fitted, kinds: Sequence[type[Effect]], seed: int) -> End:
    """The end without steps that cancel one another, of which none is the cause; the runner-up is not taken instead.

    A pair goes as a whole, as its members were only sound together. Where the rest does not come to rest, it goes too.
    """
    kept = tuple(step for step in end.steps if step not in cancelled)
    now = joined(reduce(set_free, end.apart, before), kept)
    if not kept or not now.calibrated.settled:
        kept, now = (), reduce(freed, end.apart, before)
    scores = screened(now, kinds, generator("screen without", seed))
    accepted = sorted((step.accepted for step in cancelled), key=lambda trial: -trial.merit)
    others = (trial for step in cancelled for trial in step.others)
    return End(now, kept, end.apart, (*end.scores, scores), Round((*accepted, *others, *end.last.trials), None, None))


def _backward(
    base: Fitted, steps: Sequence[Step], apart: Sequence[Described], kinds: Sequence[type[Effect]], seed: int
) -> tuple[Step, ...]:
    """Every step asked again with all the others in the model, which hid what it is when it was asked first.

    Until each was asked beside all the others that are left. A step in whose place nothing stands out any more is
    dropped; one in whose place something does that is not accepted, half of it, or one of the others, stays as it was.
    """
    kept = list(steps)
    beside = {kept[-1]: what(kept[:-1])}  # as which it was accepted
    for number in range(MOST_AGAIN):
        beside_now = {step: what(each for each in kept if each is not step) for step in kept}
        stale = next((step for step in kept if step not in beside or not beside_now[step] <= beside[step]), None)
        if stale is None:
            break
        others = [each for each in kept if each is not stale]
        without = joined(base, others)
        scores = screened(without, kinds, generator("screen again", seed, number))
        found = ask(without, scores, kinds, seed, apart)
        if not found.trials:
            kept = others  # which stood out even beside it
            continue
        again = Step(found.accepted, (), found.others) if found.accepted else stale
        if what([again]) < what([stale]) or what([again]) & what(others):
            again = stale
        kept[kept.index(stale)] = again
        beside[again] = what(others)
    return tuple(kept)
