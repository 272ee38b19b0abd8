"""Steps of closing the loop: what was added, what else it might have been, and the model that steps make together."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities
from swgsim.identification.covariance.low_rank_covariance import as_squares
from swgsim.identification.decide.candidate import Trial
from swgsim.identification.decide.competing_regularities import beside_unknown
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import extended, unbent
from swgsim.identification.fit.form_error import FORM_TOLERANCE, LEAST_GAIN, open_form, signature
from swgsim.identification.search.regularities import Described
from swgsim.identification.search.screening import Score
from swgsim.identification.search.shortlist import ALPHA

# Two effects cancel if the cosine between what they do is below the negative of this, an estimate: of pairs of library
# effects drawn at random one in a hundred is like that.
OPPOSED = 0.5
# What is left must not reach this part of the fall of the sum of squares that an effect brought.
LEFT = 0.1


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


def joined(base: Fitted, steps: Sequence[Step]) -> Fitted:
    """A model with the effects of steps, their form open within the tolerance."""
    added = [effect for step in steps for effect in step.accepted.effects]
    return open_form(extended(unbent(base), added), len(added)) if added else base


def causes(steps: Iterable[Step]) -> frozenset[tuple[object, ...]]:
    """The effects of steps: their kinds, and what of them is chosen and never fitted."""
    return frozenset(chosen(effect) for step in steps for effect in step.accepted.effects)


def chosen(effect: Effect) -> tuple[object, ...]:
    """The kind of an effect, and what of it is chosen."""
    declared = quantities(type(effect))
    return type(effect), *(getattr(effect, name) for name, q in declared.items() if q.role is Role.CHOICE)


def cancelling(steps: Sequence[Step], now: Fitted) -> tuple[Step, ...]:
    """Steps whose effects cancel much of those of another one, in a model with all of them.

    Where the cause is missing in the library, two laws that are alike, one less the other, bend into nearly any law
    between them; two causes seldom work against one another. Two of one kind are that kind in a form between theirs.
    Where one of them brings no more than the other may miss by an imperfect form, it is that one alone which is none.
    """
    owners = [step for step in steps for _ in step.accepted.effects]
    if len(owners) < 2:
        return ()
    first = len(now.model.effects) - len(owners)
    seen = now.errors.whiten(np.stack([signature(now, first + i) for i in range(len(owners))], axis=1))
    seen /= np.maximum(np.linalg.norm(seen, axis=0), np.finfo(float).tiny)
    kinds = np.array([effect.name() for step in steps for effect in step.accepted.effects])
    opposed = ((seen.T @ seen < -OPPOSED) & (kinds[:, None] != kinds)).any(axis=0)
    opposing = {step for step, each in zip(owners, opposed, strict=True) if each}
    most = max((step.accepted.evidence for step in opposing), default=0.0)
    slight = {step for step in opposing if step.accepted.evidence < FORM_TOLERANCE**2 * most}
    return tuple(step for step in steps if step in (slight or opposing))


def outweighed(steps: Iterable[Step], unknown: Sequence[Described], untried: Sequence[Score]) -> tuple[Step, ...]:
    """Steps that brought less than ten times what is left although no effect explains it.

    A cause that the library lacks looks like that: one of its effects takes a part of it. What one instrument may have
    put into its channel is another thing; so is what an effect may explain that was not tried.

    Parameters
    ----------
    steps : iterable of Step
    unknown : sequence of Described
        What is left.
    untried : sequence of Score
        Of effects that were not fitted to it, as they do not quite stand out, or as enough were added.
    """
    may_be_known = max((score.gain for score in untried), default=0.0)
    unknown = [each for each in unknown if each.gain > may_be_known]
    gain = sum(each.gain for each in unknown if not each.atom.alone)
    single: dict[str, float] = {}
    for each in unknown:
        if each.atom.alone:
            single[each.atom.pattern] = single.get(each.atom.pattern, 0.0) + each.gain
    gain += sum(single.values()) - max(single.values(), default=0.0)
    return tuple(step for step in steps if gain > LEFT * max(as_squares(step.accepted.evidence), 0.0))


def with_rivals(
    step: Step, after: Sequence[Score], found: frozenset[tuple[object, ...]], unknown: Sequence[Described] = ()
) -> Step:
    """Of the other trials, those as good as the accepted one that say nothing more once it is in the model.

    Parameters
    ----------
    step : Step
    after : sequence of Score
        Of a screening behind all that was found.
    found : frozenset
        What was found.
    unknown : sequence of Described
        What nothing that was found explains either; it must not speak against the others alone.
    """
    silent = {score.hypothesis.kind for score in after if score.chance > ALPHA}
    rivals: list[Trial] = []
    others: list[Trial] = []
    for trial in step.others:
        possible = (
            _as_good(trial, step.accepted)
            and all(type(effect) in silent or chosen(effect) in found for effect in trial.effects)
            and not found.issuperset(map(chosen, trial.effects))
        )
        rival = (trial if trial.sound else beside_unknown(trial, unknown)) if possible else None
        (rivals if rival else others).append(rival or trial)
    return Step(step.accepted, tuple(rivals), tuple(others))


def contradicted(step: Step) -> bool:
    """Whether some of the other trials is as good as the accepted one and no rival, as it contradicts itself."""
    return any(not trial.sound and _as_good(trial, step.accepted) for trial in step.others)


def _as_good(trial: Trial, best: Trial) -> bool:
    """Whether left-out operating points do not tell a trial that pays from the best one, or an imperfect form might."""
    if not trial.pays:
        return False
    difference = best.gains - trial.gains
    doubt = 2 * float(difference.std(ddof=1)) * np.sqrt(len(difference)) if len(difference) > 1 else 0.0
    # A form that is wrong by a share costs an effect the square of that share of its likelihood.
    form = FORM_TOLERANCE**2 * best.evidence
    return bool(max(difference.sum(), best.evidence - trial.evidence) < max(LEAST_GAIN, doubt, form))
