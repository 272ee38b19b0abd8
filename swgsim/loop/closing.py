"""Closing the loop: ask, add, and ask again; then ask for each effect once more with all the others in the model."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from swgsim.effects.base import Effect
from swgsim.loop.asking import ALPHA, Round, ask, ask_behind, screened
from swgsim.loop.evidence import FORM_TOLERANCE, allowance
from swgsim.loop.fitting import Fitted, extended, fit
from swgsim.loop.screening import Score
from swgsim.loop.session import Measured
from swgsim.loop.trial import LEAST_GAIN, Trial, widened
from swgsim.loop.unit import Unit
from swgsim.loop.vocabulary import Described, set_free
from swgsim.seeds import generator

# Effects that are added at most, and disturbances of single channels that are set apart for one behind them at most.
MOST, SET_APART = 3, 2


@dataclass(frozen=True, eq=False)
class Step:
    """One effect, or a pair, that was added.

    Attributes
    ----------
    accepted : Trial
    rivals : tuple of Trial
        Trials that the recordings cannot tell from it.
    others : tuple of Trial
        Trials that were worse.
    """

    accepted: Trial
    rivals: tuple[Trial, ...]
    others: tuple[Trial, ...]


@dataclass(frozen=True, eq=False)
class Closed:
    """What closing the loop found.

    Attributes
    ----------
    before, after : Fitted
        The model without and with what was found.
    asked : Fitted
        The latter with the form of what was found open within the tolerance: of what this leaves it is asked what more
        is missing.
    steps : tuple of Step
    scores : tuple of Score
        Of the first screening, best hypothesis of each effect.
    left : tuple of Score
        Of the last screening.
    rejected : tuple of Trial
        Significant, but of the wrong form: they contradict themselves, or a bare regularity explains more.
    outdone_by : Described or None
        That regularity.
    apart : tuple of Described
        Disturbances of single channels that were set apart before an effect was found behind them.
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

    @property
    def nearest(self) -> Trial | None:
        """Of what was rejected: the trial that came nearest."""
        return self.rejected[0] if self.rejected and np.isfinite(self.rejected[0].merit) else None

    @property
    def deviation(self) -> dict[str, float]:
        """Standard deviation of each fitted parameter, by noise and by an imperfect form."""
        found = [each for step in self.steps for each in step.accepted.coherence]
        return widened(self.after.deviation, self.after.model, len(self.before.model.effects), found)


class Asked(NamedTuple):
    """Where asking came to its end.

    Attributes
    ----------
    now : Fitted
        With what was found, its form open within the tolerance.
    steps : tuple of Step
    apart : tuple of Described
        What was set apart.
    scores : tuple of tuple of Score
        Of each screening; the last found nothing more.
    last : Round
        What the last asking gave.
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
    asked = _forward(before, (), (), kinds, seed)
    first = asked.scores[0]
    if len(asked.steps) > 1:
        base = before
        for each in asked.apart:
            base = set_free(base, each)
        revised = _backward(base, asked.steps, kinds, seed)
        if _names(revised) == _names(asked.steps):
            asked = asked._replace(steps=revised)
        else:
            asked = _forward(_joined(base, revised), revised, asked.apart, kinds, seed)
    left = asked.scores[-1]
    steps = tuple(_with_rivals(step, left) for step in asked.steps)
    return Closed(
        before, asked.now.strict, asked.now, steps, first, left, asked.last.trials, asked.last.outdone_by, asked.apart
    )


def _forward(
    now: Fitted, steps: tuple[Step, ...], apart: tuple[Described, ...], kinds: Sequence[type[Effect]], seed: int
) -> Asked:
    """Add what is accepted until nothing more is."""
    scores: tuple[tuple[Score, ...], ...] = ()
    while True:
        number = len(steps)
        scores = (*scores, screened(now, kinds, generator("screen", seed, number)))
        found = ask(now, scores[-1] if number < MOST else (), kinds, seed, number)
        if found.trials and not found.accepted:
            found, taken = ask_behind(now, found, kinds, seed, number, SET_APART - len(apart))
            apart += taken
        if found.accepted is None:
            return Asked(now, steps, apart, scores, found)
        steps = (*steps, Step(found.accepted, (), found.others))
        now = found.accepted.with_open_form


def _backward(base: Fitted, steps: tuple[Step, ...], kinds: Sequence[type[Effect]], seed: int) -> tuple[Step, ...]:
    """Each step asked again with all the others in the model, which hid what it is when it was asked first.

    The last one was asked so. A step in whose place nothing stands out any more is dropped; one in whose place
    something does that is not accepted stays as it was.
    """
    kept = steps
    for number, step in enumerate(steps[:-1]):
        others = tuple(each for each in kept if each is not step)
        without = _joined(base, others)
        scores = screened(without, kinds, generator("screen again", seed, number))
        found = ask(without, scores, kinds, seed, number)
        if not found.trials:
            kept = others
        elif found.accepted:
            again = Step(found.accepted, (), found.others)
            kept = tuple(again if each is step else each for each in kept)
    return kept


def _joined(base: Fitted, steps: Sequence[Step]) -> Fitted:
    """A model with the effects of steps, their form open within the tolerance."""
    fitted = extended(base, [effect for step in steps for effect in step.accepted.effects])
    added = range(len(base.model.effects), len(fitted.model.effects))
    return fitted.allowing(np.hstack([allowance(fitted, number) for number in added]))


def _names(steps: Sequence[Step]) -> list[list[str]]:
    """The effects of each step."""
    return [[effect.name() for effect in step.accepted.effects] for step in steps]


def _with_rivals(step: Step, after: Sequence[Score]) -> Step:
    """Of the other trials, those as good as the accepted one that say nothing more once it is in the model."""
    silent = {score.hypothesis.kind for score in after if score.chance > ALPHA}
    rivals = tuple(
        t for t in step.others if t.sound and _as_good(t, step.accepted) and t.score.hypothesis.kind in silent
    )
    return Step(step.accepted, rivals, tuple(t for t in step.others if t not in rivals))


def _as_good(trial: Trial, best: Trial) -> bool:
    """Whether left-out operating points do not tell a trial from the best one, or an imperfect form might."""
    difference = best.gains - trial.gains
    doubt = 2 * float(difference.std(ddof=1)) * np.sqrt(len(difference)) if len(difference) > 1 else 0.0
    # A form that is wrong by a share costs an effect the square of that share of its likelihood.
    form = FORM_TOLERANCE**2 * best.evidence
    return bool(max(difference.sum(), best.evidence - trial.evidence) < max(LEAST_GAIN, doubt, form))
