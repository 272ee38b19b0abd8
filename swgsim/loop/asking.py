"""Asking once what a model lacks: screen, refine, fit, and judge the best."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from swgsim.effects.base import Effect
from swgsim.loop.beside import elsewhere, in_company, outdone
from swgsim.loop.fitting import Fitted, unbent
from swgsim.loop.hypotheses import hypotheses, signatures
from swgsim.loop.screening import Score, best_of_kind, screen
from swgsim.loop.trial import Trial, begun, tried
from swgsim.loop.vocabulary import Described, describe, freed, strongest
from swgsim.seeds import generator

# Probability of a false effect on recordings in which nothing is missing.
ALPHA = 0.005
# Disturbances of single channels that are set apart for an effect behind them, at most.
SET_APART = 2
# Leaders that are fitted, and those that are as good but for this share of the gain and may be rivals.
LEADERS, NEARLY, NEARLY_LEADERS = 4, 0.05, 8
# Log-likelihood that a pair must gain over its better half; beside the leaders, so many are tried that lead behind it.
PAIR_GAIN, BEHIND = 15.0, 2


class Round(NamedTuple):
    """What asking once gave: fits, single effects first and the best of them leading; what of them is accepted; the
    regularity that outdoes it.
    """

    trials: tuple[Trial, ...]
    accepted: Trial | None
    outdone_by: Described | None

    @property
    def others(self) -> tuple[Trial, ...]:
        """The fits of effects that were not accepted."""
        return tuple(t for t in self.trials if self.accepted is None or t.effects != self.accepted.effects)


def ask(
    now: Fitted,
    scores: Sequence[Score],
    kinds: Sequence[type[Effect]],
    seed: int,
    apart: Sequence[Described] = (),
) -> Round:
    """Fit the best hypotheses, and judge the best of them, behind what was set apart."""
    leaders = _leaders(scores)
    if not leaders:
        return Round((), None, None)
    start = unbent(now)
    alone = (tried(now, score, (begun(start, score, seed),), start) for score in leaders)
    trials = tuple(sorted(alone, key=lambda trial: -trial.merit))
    best = trials[0]
    pairs = () if best.sound else _pairs(now, start, trials, kinds, seed)
    accepted = best if best.sound else _worth_it(pairs, best) or in_company(now, best, ALPHA, seed)
    if accepted is None or not elsewhere(accepted, apart, now):
        return Round(trials, None, None)
    plain = describe(now)[0]
    if outdone(accepted, plain, now):
        # What the regularity tells beyond an effect may be a second one.
        pairs = _pairs(now, start, trials, kinds, seed) if best.sound else ()
        accepted = _worth_it(pairs, best)
        if accepted is None or not elsewhere(accepted, apart, now) or outdone(accepted, plain, now):
            return Round(trials, None, plain)
    return Round((*trials, *pairs) if accepted in pairs else trials, accepted, None)


def ask_behind(
    now: Fitted,
    found: Round,
    kinds: Sequence[type[Effect]],
    seed: int,
    number: int,
    apart: tuple[Described, ...],
) -> tuple[Round, tuple[Described, ...]]:
    """What is accepted once disturbances of single channels that dwarf it are set apart too; else what was found."""
    before = apart
    while len(apart) < SET_APART:
        more = len(apart) - len(before)
        plain = strongest(now, generator("set apart", seed, number, more))
        if plain.chance > ALPHA or not plain.atom.alone:
            break
        now, apart = freed(now, plain), (*apart, plain)
        scores = screened(now, kinds, generator("screen beside", seed, number, more + 1))
        behind = ask(now, scores, kinds, seed, apart)
        if behind.accepted:
            return behind, apart
    return found, before


def screened(fitted: Fitted, kinds: Sequence[type[Effect]], rng: np.random.Generator) -> tuple[Score, ...]:
    """The best hypothesis of every effect that was not added yet."""
    found = [each for each in hypotheses(kinds) if not any(map(each.repeats, fitted.added))]
    if not found:
        return ()
    fitted = unbent(fitted)
    return tuple(best_of_kind(screen(found, signatures(found, fitted.model, fitted.measured), fitted, rng)))


def _leaders(scores: Sequence[Score]) -> list[Score]:
    """What is fitted: the best scores that are no luck, and those hardly worse than the very best."""
    real = [score for score in scores if score.chance <= ALPHA]
    nearly = [s for s in real[LEADERS:NEARLY_LEADERS] if s.gain > (1 - NEARLY) * real[0].gain]
    return [*real[:LEADERS], *nearly]


def _pairs(
    now: Fitted, start: Fitted, trials: Sequence[Trial], kinds: Sequence[type[Effect]], seed: int
) -> tuple[Trial, ...]:
    """Two effects that may hide one another: pairs with the best trial, the best one first."""
    first = trials[0]
    beside = unbent(first.fitted)
    behind = _leaders(screened(beside, kinds, generator("screen behind", seed)))[:BEHIND]
    others = {type(effect): effect for trial in trials[1:LEADERS] for effect in trial.effects}
    # What leads behind the first shows where it is only beside it.
    others |= {type(effect): effect for effect in (begun(beside, score, seed) for score in behind)}
    pairs = (
        tried(now, first.score, (*first.effects, effect), start)
        for kind, effect in others.items()
        if kind is not first.score.hypothesis.kind
    )
    return tuple(sorted(pairs, key=lambda pair: -pair.merit))


def _worth_it(pairs: Sequence[Trial], better_half: Trial) -> Trial | None:
    """The best pair, if both of its members are sound together and it gains more than one of them alone."""
    best = pairs[0] if pairs else None
    return best if best and best.sound and best.merit > better_half.merit + 2 * PAIR_GAIN else None
