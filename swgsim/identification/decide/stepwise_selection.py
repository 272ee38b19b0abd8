"""Closing the loop: ask, add, and ask again; then ask for each effect once more with all the others in the model."""

from collections.abc import Iterable, Sequence
from functools import reduce
from typing import NamedTuple

from swgsim.common.seeds import generator
from swgsim.effects.base import Effect
from swgsim.identification.data.measured import Measured
from swgsim.identification.decide.accepted import (
    Step,
    cancelling,
    causes,
    contradicted,
    joined,
    outweighed,
    with_rivals,
)
from swgsim.identification.decide.candidate import Trial, seen
from swgsim.identification.decide.selection import Closed
from swgsim.identification.decide.selection_step import Round, ask, ask_behind, ask_imperfect
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import extended, fit, unbent
from swgsim.identification.fit.form_error import signature
from swgsim.identification.fit.unit import Unit
from swgsim.identification.search.detection_limit import at_sizes_seen
from swgsim.identification.search.regularities import Described, freed, regularities, set_free
from swgsim.identification.search.screening import Score
from swgsim.identification.search.shortlist import ALPHA, screened

# Steps at most, each one effect or a pair.
MOST_STEPS = 3
# Times that an effect is asked again with all the others in the model, at most.
MOST_AGAIN = 6


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
    first = fit(measured, unit)
    forward = _forward(first, (), (), kinds, seed)
    before = first.with_zeros(forward.now.measured.zeros)
    end = _revised(forward, before, kinds, seed)
    cancelled = cancelling(end.steps, end.now)
    if cancelled:
        end = _without(cancelled, end, before, kinds, seed)
    end, light, unknown = _weighed(end, before, kinds, seed)
    named = causes(end.steps) | causes(cancelled) | causes(light)
    return Closed(
        before=before,
        after=_together(end),
        asked=end.now,
        steps=_beside_rivals(end, unknown),
        scores=at_sizes_seen(forward.scores[0], unbent(first)),
        left=end.scores[-1],
        rejected=end.last.trials,
        outdone_by=end.last.outdone_by,
        apart=end.apart,
        withdrawn=_accepted(step for step in forward.steps if not causes([step]) <= named),
        cancelling=_accepted(cancelled),
        outweighed=_accepted(light),
        unknown=(*end.apart, *unknown),
    )


def _accepted(steps: Iterable[Step]) -> tuple[Trial, ...]:
    return tuple(step.accepted for step in steps)


def _revised(forward: End, before: Fitted, kinds: Sequence[type[Effect]], seed: int) -> End:
    """The end with every step asked again, and from where others stand in their places, asking to the end once more."""
    if len(forward.steps) < 2:
        return forward
    base = reduce(set_free, forward.apart, before)
    revised = _backward(base, forward.steps, forward.apart, kinds, seed)
    if [causes([step]) for step in revised] == [causes([step]) for step in forward.steps]:
        return forward._replace(steps=revised)
    together = joined(base, revised)
    return _forward(together, revised, forward.apart, kinds, seed) if together.calibrated.settled else forward


def _weighed(
    end: End, before: Fitted, kinds: Sequence[type[Effect]], seed: int
) -> tuple[End, tuple[Step, ...], tuple[Described, ...]]:
    """The end without steps that are outweighed by what is left, these steps, and what is left."""
    light: tuple[Step, ...] = ()
    unknown = regularities(end.now, seed)
    while more := outweighed(end.steps, unknown, _untried(end)):
        end = _without(more, end, before, kinds, seed)
        light = (*light, *more)
        unknown = regularities(end.now, seed)
    return end, light, unknown


def _beside_rivals(end: End, unknown: Sequence[Described]) -> tuple[Step, ...]:
    """The steps with their rivals; what is left may speak against one only where a trial that is as good contradicts
    itself.
    """
    found = causes(end.steps)
    spoiling = unknown[:1] if any(map(contradicted, end.steps)) else ()
    return tuple(with_rivals(step, end.scores[-1], found, spoiling) for step in end.steps)


def _together(end: End) -> Fitted:
    """The model with all that was found, fitted once more with nothing of its form open.

    The size of an effect whose form was open when the next one was added is that of the parts that this leaves alone;
    the interval of a size is of a fit to all of them.
    """
    if len(end.steps) < 2 and not any(step.accepted.imperfect for step in end.steps):
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
        found = ask(now, scores[-1] if number < MOST_STEPS else (), kinds, seed, apart)
        if not (found.accepted or steps or apart) and now.balanced is now:
            found = ask_imperfect(now, found, kinds, seed)
        if found.trials and not found.accepted:
            found, apart = ask_behind(now, found, kinds, seed, number, apart)
        if not found.accepted and now.balanced is not now:
            now = now.balanced
            continue  # no effect explains where the zeros of gauges lie
        if found.accepted is None:
            return End(now, steps, apart, scores, found)
        steps = (*steps, Step(found.accepted, (), found.others))
        now = found.accepted.with_open_form


def _without(dropped: Sequence[Step], end: End, before: Fitted, kinds: Sequence[type[Effect]], seed: int) -> End:
    """The end without steps of which none is the cause after all; the runner-up is not taken instead.

    A pair goes as a whole, as its members were only sound together. Where the rest does not come to rest, it goes too.
    """
    kept = tuple(step for step in end.steps if step not in dropped)
    now = joined(reduce(set_free, end.apart, before), kept)
    if not kept or not now.calibrated.settled:
        kept, now = (), reduce(freed, end.apart, before)
    scores = screened(now, kinds, generator("screen without", seed))
    accepted = sorted((step.accepted for step in dropped), key=lambda trial: -trial.merit)
    others = (trial for step in dropped for trial in step.others)
    return End(now, kept, end.apart, (*end.scores, scores), Round((*accepted, *others, *end.last.trials), None, None))


def _untried(end: End) -> list[Score]:
    """Effects that were not fitted to what is left."""
    return [score for score in end.scores[-1] if score.chance > ALPHA or len(end.steps) >= MOST_STEPS]


def _backward(
    base: Fitted, steps: Sequence[Step], apart: Sequence[Described], kinds: Sequence[type[Effect]], seed: int
) -> tuple[Step, ...]:
    """Every step asked again with all the others in the model, which hid what it is when it was asked first.

    Until each was asked beside all the others that are left. A step in whose place nothing stands out any more is
    dropped; one in whose place something does that is not accepted, half of it, or one of the others, stays as it was,
    and so does one of an imperfect form, as in its own it does not stand out.
    """
    kept = list(steps)
    beside = {kept[-1]: causes(kept[:-1])}  # as which it was accepted
    for number in range(MOST_AGAIN):
        beside_now = {step: causes(each for each in kept if each is not step) for step in kept}
        asked_again = (step for step in kept if not step.accepted.imperfect)
        stale = next((s for s in asked_again if s not in beside or not beside_now[s] <= beside[s]), None)
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
        if causes([again]) < causes([stale]) or causes([again]) & causes(others):
            again = stale
        kept[kept.index(stale)] = again
        beside[again] = causes(others)
    return tuple(kept)
