"""An effect beside bare regularities: they may spoil its form, tell the same better, dwarf it, or be part of it."""

from collections.abc import Sequence
from dataclasses import replace
from functools import reduce

import numpy as np
from jaxtyping import Bool

from swgsim.common.seeds import generator
from swgsim.effects.regularity import LAWS, PATTERNS
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.decide.candidate import Trial, gain
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.form_error import OUTDONE, OUTDONE_SHARE, Coherence, coherence
from swgsim.identification.search.regularities import Described, columns, freed, set_free, strongest
from swgsim.identification.search.shortlist import ALPHA

# A regularity that explains more than an effect explains the same thing only if it leaves the effect less than half of
# its gain. What explains so many times more makes any effect beside it doubtful, even if it is another thing.
SAME_THING, DWARFED = 0.5, 4.0
# Regularities that may spoil the agreement of an effect's parts, at most; it keeps so much of its gain if they are
# another thing.
COMPANY, ANOTHER_THING = 2, 0.8
# What is found behind disturbances of single channels acts elsewhere too, in other channels or other lines than theirs,
# if more than this share of its sum of squares is there.
ELSEWHERE = 0.25


def outdone(trial: Trial, plain: Described, now: Fitted) -> bool:
    """Whether a bare regularity explains what a trial explains, and more; or by far more of something else."""
    if gain(trial.with_open_form, columns(plain.atom, now)) <= OUTDONE:
        return False  # beyond what the tolerance of form allows the effect, it says nothing more
    explained = trial.explained(now)
    if plain.gain <= explained * (1 + OUTDONE_SHARE) + OUTDONE:
        return False
    return plain.gain > DWARFED * explained or trial.explained(freed(now, plain)) < SAME_THING * explained


def in_company(now: Fitted, trial: Trial, seed: int) -> Trial | None:
    """A trial that pays, if its parts agree once regularities that have nothing to do with it are taken out.

    Parameters
    ----------
    now : Fitted
        The model without it.
    trial : Trial
    seed : int
    """
    if not trial.pays:
        return None
    before, after, explained = now, trial.fitted, trial.explained(now)
    beside: tuple[Described, ...] = ()
    for number in range(COMPANY):
        best = strongest(after, generator("company", seed, number))
        before, after, beside = set_free(before, best), set_free(after, best), (*beside, best)
        if best.chance > ALPHA or trial.explained(before) < max(ANOTHER_THING * explained, best.gain):
            return None
        agreement = _agreement(trial, after)
        if all(each.holds for each in agreement):
            return replace(trial, coherence=agreement, beside=beside)
    return None


def beside_unknown(trial: Trial, unknown: Sequence[Described]) -> Trial | None:
    """A trial that pays, if it is another thing than what nothing explains and its parts agree once that is taken out.

    Parameters
    ----------
    trial : Trial
    unknown : sequence of Described
    """
    if not unknown or not trial.pays:
        return None
    whiten = trial.fitted.errors.whiten
    taken, _ = np.linalg.qr(whiten(np.hstack([columns(each.atom, trial.fitted) for each in unknown])))
    seen = whiten(trial.signature)
    beyond = seen - taken @ (taken.T @ seen)
    if (np.linalg.norm(beyond, axis=0) ** 2 < ANOTHER_THING * np.linalg.norm(seen, axis=0) ** 2).any():
        return None
    agreement = _agreement(trial, reduce(set_free, unknown, trial.fitted))
    return replace(trial, coherence=agreement, beside=tuple(unknown)) if all(a.holds for a in agreement) else None


def _agreement(trial: Trial, fitted: Fitted) -> tuple[Coherence, ...]:
    """Whether the parts of its effects agree in this fit."""
    known = len(trial.fitted.model.effects) - len(trial.effects)
    return tuple(coherence(fitted, known + i) for i in range(len(trial.effects)))


def more_than(apart: Sequence[Described], trial: Trial, now: Fitted, seed: int) -> bool:
    """Whether effects found behind disturbances of single channels are more than parts of them.

    They are if they act on other channels too; or if the disturbances are larger than anything that the gear has there,
    and so are no change of its own lines. But effects that are hardly anything but the lines of the disturbances cannot
    be what is behind them. And where the strongest of what they leave is of such a channel alone, nobody knows what its
    disturbance is, and where it ends.

    Parameters
    ----------
    apart : sequence of Described
        The disturbances.
    trial : Trial
    now : Fitted
        The model without the effects, in which the disturbances are free.
    seed : int
    """
    if not apart:
        return True
    layout = now.measured.layout
    of_channels = [np.isin(layout.channel, list(PATTERNS[each.atom.pattern])) for each in apart]
    of_lines = [mine & (layout.order == each.atom.order) for mine, each in zip(of_channels, apart, strict=True)]
    on_others = _elsewhere(trial, now.whole, np.any(of_channels, axis=0)).all()
    if not on_others and not all(_foreign(each, now) for each in apart):
        return False
    # By the errors alone: a disturbance that is free absorbs what follows its law, and the rest would seem to be all.
    # Of a pair one is enough, as the line of the other one may have been set apart before both were tried.
    if not _elsewhere(trial, now.errors, np.any(of_lines, axis=0)).any():
        return False
    left = strongest(trial.with_open_form, generator("more than apart", seed, len(apart)))
    return left.chance > ALPHA or left.atom.pattern not in {each.atom.pattern for each in apart}


def _foreign(disturbance: Described, now: Fitted) -> bool:
    """Whether a disturbance of one channel is larger than the line that it is added to, each where it is largest."""
    measured, atom = now.measured, disturbance.atom
    (channel,) = PATTERNS[atom.pattern]
    expected = (measured.values.ravel() - now.residual).reshape(measured.values.shape)
    own = measured.layout.lines(expected)[:, measured.layout.channels.index(channel), atom.order]
    law = [LAWS[atom.law](situation.point, situation.conditions) for situation in measured.situations]
    return bool(disturbance.amplitude * np.abs(law).max() > np.abs(own).max())


def _elsewhere(
    trial: Trial, errors: Covariance, disturbed: Bool[np.ndarray, " feature"]
) -> Bool[np.ndarray, " effect"]:
    """Whether enough of an effect of a trial is in what is not disturbed."""
    if disturbed.all():
        return np.zeros(trial.signature.shape[1], bool)
    there = trial.signature[np.tile(~disturbed, len(trial.signature) // len(disturbed))]
    beyond = np.linalg.norm(errors.features(~disturbed).whiten(there), axis=0)
    return beyond**2 > ELSEWHERE * np.linalg.norm(errors.whiten(trial.signature), axis=0) ** 2
