"""Closing the loop: screen, refine, fit, judge, add, and ask again."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from swgsim.effects.base import Effect
from swgsim.loop.beside import in_company, outdone
from swgsim.loop.fitting import Fitted, fit
from swgsim.loop.hypotheses import hypotheses, signatures
from swgsim.loop.screening import Score, best_of_kind, screen
from swgsim.loop.session import Measured
from swgsim.loop.trial import LEAST_GAIN, Trial, begun, tried, widened
from swgsim.loop.unit import Unit
from swgsim.loop.vocabulary import Described, describe, set_free
from swgsim.seeds import generator

# Probability of a false effect on recordings in which nothing is missing.
ALPHA = 0.005
# Leaders that are fitted, those that are as good but for this share of the gain and may be rivals, and effects that are
# added at most.
LEADERS, NEARLY, NEARLY_LEADERS, MOST = 4, 0.05, 8, 3
# Disturbances of single channels that may stand before an effect and are set apart for it, at most.
SET_APART = 2
# Log-likelihood that a pair must gain over its better half; beside the leaders, so many are tried that lead behind it.
PAIR_GAIN, BEHIND = 15.0, 2


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
    before = now = fit(measured, unit)
    steps: list[Step] = []
    apart: tuple[Described, ...] = ()
    first: tuple[Score, ...] | None = None
    while True:
        scores = _screened(now, kinds, generator("screen", seed, len(steps)))
        first = scores if first is None else first
        if steps:
            steps[-1] = _with_rivals(steps[-1], scores)
        found = _round(now, scores if len(steps) < MOST else (), kinds, seed, len(steps))
        if found.trials and not found.accepted:
            found, taken = _behind(now, found, kinds, seed, len(steps), SET_APART - len(apart))
            apart += taken
        if found.accepted is None:
            break
        others = tuple(trial for trial in found.trials if trial.effects != found.accepted.effects)
        steps.append(Step(found.accepted, (), others))
        now = found.accepted.with_open_form
    return Closed(before, now.strict, now, tuple(steps), first, scores, found.trials, found.outdone_by, apart)


class Round(NamedTuple):
    """What asking once gave: fits, the best first; what of them is accepted; the regularity that outdoes it."""

    trials: tuple[Trial, ...]
    accepted: Trial | None
    outdone_by: Described | None


def _round(now: Fitted, scores: Sequence[Score], kinds: Sequence[type[Effect]], seed: int, number: int) -> Round:
    """Fit the best hypotheses, and judge the best of them."""
    leaders = _leaders(scores)
    if not leaders:
        return Round((), None, None)
    trials = tuple(sorted((_alone(now, score, seed) for score in leaders), key=lambda trial: -trial.merit))
    best = trials[0]
    accepted = best if best.sound else _pair(now, trials, kinds, seed) or in_company(now, best, ALPHA, seed)
    if accepted is None:
        return Round(trials, None, None)
    plain = describe(now, generator("vocabulary of a step", seed, number))[0]
    return Round(trials, None, plain) if outdone(accepted, plain, now) else Round(trials, accepted, None)


def _behind(
    now: Fitted, found: Round, kinds: Sequence[type[Effect]], seed: int, number: int, most: int
) -> tuple[Round, tuple[Described, ...]]:
    """What is accepted once disturbances of single channels, which dwarf it, are set apart; else what was found."""
    apart: tuple[Described, ...] = ()
    while len(apart) < most:
        plain = describe(now, generator("set apart", seed, number, len(apart)))[0]
        if plain.chance > ALPHA or not plain.atom.alone:
            break
        now, apart = set_free(now, plain), (*apart, plain)
        scores = _screened(now, kinds, generator("screen beside", seed, number, len(apart)))
        behind = _round(now, scores, kinds, seed, number)
        if behind.accepted:
            return behind, apart
    return found, ()


def _screened(fitted: Fitted, kinds: Sequence[type[Effect]], rng: np.random.Generator) -> tuple[Score, ...]:
    """The best hypothesis of every effect."""
    found = list(hypotheses(kinds))
    return tuple(best_of_kind(screen(found, signatures(found, fitted.model, fitted.measured), fitted, rng)))


def _leaders(scores: Sequence[Score]) -> list[Score]:
    """What is fitted: the best scores that are no luck, and those hardly worse than the very best."""
    real = [score for score in scores if score.chance <= ALPHA]
    nearly = [s for s in real[LEADERS:NEARLY_LEADERS] if s.gain > (1 - NEARLY) * real[0].gain]
    return [*real[:LEADERS], *nearly]


def _pair(now: Fitted, trials: Sequence[Trial], kinds: Sequence[type[Effect]], seed: int) -> Trial | None:
    """Two effects that hide one another: the best pair with the best trial, if both members are sound together."""
    first = trials[0]
    behind = _leaders(_screened(first.fitted, kinds, generator("screen behind", seed)))[:BEHIND]
    others = {type(effect): effect for trial in trials[1:LEADERS] for effect in trial.effects}
    # What leads behind the first shows where it is only beside it.
    others |= {type(effect): effect for effect in (begun(first.fitted, score, seed) for score in behind)}
    pairs = [
        tried(now, first.score, (*first.effects, effect))
        for kind, effect in others.items()
        if kind is not first.score.hypothesis.kind
    ]
    best = max(pairs, key=lambda pair: pair.merit, default=None)
    return best if best and best.sound and best.merit > first.merit + 2 * PAIR_GAIN else None


def _alone(now: Fitted, score: Score, seed: int) -> Trial:
    """The hypothesis of a score, on its own."""
    return tried(now, score, (begun(now, score, seed),))


def _with_rivals(step: Step, after: Sequence[Score]) -> Step:
    """Of the other trials, those as good as the accepted one that say nothing more once it is in the model."""
    silent = {score.hypothesis.kind for score in after if score.chance > ALPHA}
    others = (*step.rivals, *step.others)
    rivals = tuple(t for t in others if t.sound and _as_good(t, step.accepted) and t.score.hypothesis.kind in silent)
    return Step(step.accepted, rivals, tuple(t for t in others if t not in rivals))


def _as_good(trial: Trial, best: Trial) -> bool:
    """Whether left-out operating points do not tell a trial from the best one."""
    difference = best.gains - trial.gains
    doubt = 2 * float(difference.std(ddof=1)) * np.sqrt(len(difference)) if len(difference) > 1 else 0.0
    return bool(max(difference.sum(), best.evidence - trial.evidence) < max(LEAST_GAIN, doubt))
