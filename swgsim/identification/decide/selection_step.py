"""Asking once what a model lacks: screen, refine, fit, and judge the best."""

from collections.abc import Sequence
from typing import NamedTuple

from swgsim.common.seeds import generator
from swgsim.effects.base import Effect
from swgsim.identification.decide.candidate import LIKELIER, Trial, tried
from swgsim.identification.decide.competing_regularities import in_company, more_than, outdone
from swgsim.identification.decide.form_error_evidence import imperfect
from swgsim.identification.decide.pairs import of_doubles, paired, worth_it
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import unbent
from swgsim.identification.search.refining import zoom
from swgsim.identification.search.regularities import Described, describe, freed, strongest
from swgsim.identification.search.screening import Score
from swgsim.identification.search.shortlist import ALPHA, leaders, screened

# Disturbances of single channels that are set apart for an effect behind them, at most.
SET_APART = 2


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
    leading = leaders(scores)
    if not leading:
        return Round((), None, None)
    start = unbent(now)
    alone = (tried(now, score, (zoom(score, start),), start) for score in leading)
    trials = tuple(sorted(alone, key=lambda trial: -trial.merit))
    if all(trial.evidence <= LIKELIER for trial in trials):
        return Round((), None, None)  # the luck of a wide search
    best = trials[0]
    pairs = () if best.sound else paired(now, start, trials, kinds, seed)
    accepted = best if best.sound else worth_it(pairs, best, now) or in_company(now, best, seed)
    if accepted is None or not more_than(apart, accepted, now, seed):
        return Round(trials, None, None)
    plain = describe(now)[0]
    if outdone(accepted, plain, now):
        # What the regularity tells beyond an effect may be a second one.
        pairs = paired(now, start, trials, kinds, seed) if best.sound else ()
        accepted = worth_it(pairs, best, now)
        if accepted is None or not more_than(apart, accepted, now, seed) or outdone(accepted, plain, now):
            return Round(trials, None, plain)
    if accepted in pairs:
        trials = (*trials, *pairs, *of_doubles(accepted, now, start, trials, pairs))
    return Round(trials, accepted, None)


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
        if plain.chance > ALPHA or not plain.atom.alone or (plain.atom.order == 0 and now.balanced is not now):
            break  # a zero that lies off counts as a bridge balanced anew, if that is likelier
        now, apart = freed(now, plain), (*apart, plain)
        scores = screened(now, kinds, generator("screen beside", seed, number, more + 1))
        behind = ask(now, scores, kinds, seed, apart)
        if behind.accepted:
            return behind, apart
    return found, before


def ask_imperfect(now: Fitted, found: Round, kinds: Sequence[type[Effect]], seed: int) -> Round:
    """What is accepted in an imperfect form, where nothing was in its own; else what was found."""
    trials = imperfect(now, kinds, seed)
    return Round((*trials, *found.trials), trials[0], None) if trials else found
