"""Closing the loop: screen, refine, fit, judge, add, and ask again."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.quantity import quantities, size_of
from swgsim.loop.evidence import Coherence, allowance, coherence, signature
from swgsim.loop.fitting import Fitted, Unit, extended, fit
from swgsim.loop.hypotheses import hypotheses, signatures
from swgsim.loop.refining import zoom
from swgsim.loop.screening import Score, best_of_kind, screen
from swgsim.loop.session import Measured
from swgsim.loop.vocabulary import Described, columns, describe, set_free
from swgsim.seeds import generator

# Probability of a false effect on recordings in which nothing is missing.
ALPHA = 0.005
# A bare regularity of the open vocabulary explains the same thing better than an effect only if it does so by this much
# (twice a log-likelihood, and a share), and leaves the effect less than half of its gain. What explains so many times
# more makes any effect beside it doubtful, even if it is another thing.
OUTDONE, OUTDONE_SHARE, SAME_THING, DWARFED = 17.0, 0.05, 0.5, 4.0
# Regularities beside an effect that may spoil the agreement of its parts, at most; it keeps so much of its gain if they
# are another thing.
COMPANY, ANOTHER_THING = 2, 0.8
# Share to which the chain has the size of an effect right at all: an estimate, of what its mesh makes.
EXACT = 0.03
# Leaders that are fitted, those that are as good but for this share of the gain and may be rivals, and effects that are
# added at most.
LEADERS, NEARLY, NEARLY_LEADERS, MOST = 4, 0.05, 8, 3
# Log-likelihood of left-out operating points that an effect must gain, and a pair over its better half.
LEAST_GAIN, PAIR_GAIN = 3.0, 15.0
# Log-likelihood of all recordings that it must gain if left-out points do not tell.
LEAST_EVIDENCE = 10.0


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
        Of the log-likelihood of each operating point left out.
    evidence : float
        Of the log-likelihood of all recordings together, their parameters being open within their spreads. It also
        counts what every operating point shows alike, such as a zero beyond its spread, which the others tell already.
    coherence : tuple of Coherence
        Of each effect of the trial.
    """

    score: Score
    effects: tuple[Effect, ...]
    fitted: Fitted
    gains: Float[np.ndarray, " point"]
    evidence: float
    coherence: tuple[Coherence, ...]

    @property
    def gain(self) -> float:
        """Of all operating points."""
        return float(self.gains.sum())

    @cached_property
    def signature(self) -> Float[np.ndarray, "row effect"]:
        """What each of its effects does to the features."""
        first = len(self.fitted.model.effects) - len(self.effects)
        return np.stack([signature(self.fitted, first + i) for i in range(len(self.effects))], axis=1)

    def explained(self, before: Fitted) -> float:
        """Fall of the residual's sum of squares that it brings to the model before, as a score counts it."""
        return _gain(before, self.signature)

    @property
    def sound(self) -> bool:
        """Whether it pays on operating points it was not fitted on, and does not contradict itself."""
        pays = self.gain > LEAST_GAIN or (self.evidence > LEAST_EVIDENCE and self.gain > -LEAST_GAIN)
        return pays and all(each.holds for each in self.coherence) and self.fitted.calibrated.settled

    @property
    def merit(self) -> float:
        """What trials are ordered by."""
        return self.gain + self.evidence


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
    """

    before: Fitted
    after: Fitted
    asked: Fitted
    steps: tuple[Step, ...]
    scores: tuple[Score, ...]
    left: tuple[Score, ...]
    rejected: tuple[Trial, ...]

    @property
    def deviation(self) -> dict[str, float]:
        """Standard deviation of each fitted parameter; of a size also by what an imperfect form leaves in doubt."""
        found = dict(self.after.deviation)
        number = len(self.before.model.effects)
        for agreement in (each for step in self.steps for each in step.accepted.coherence):
            effect, number = self.after.model.effects[number], number + 1
            size = size_of(type(effect))
            by = getattr(effect, size) - quantities(type(effect))[size].nothing
            name = f"{effect.title()} {number}: {size}"
            found[name] = float(np.linalg.norm([found[name], agreement.doubt * by, EXACT * by]))
        return found


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
    rejected: tuple[Trial, ...] = ()
    first: tuple[Score, ...] | None = None
    while True:
        scores = _screened(now, kinds, generator("screen", seed, len(steps)))
        first = scores if first is None else first
        leaders = _leaders(scores)
        if steps and leaders:
            steps[-1] = _with_rivals(steps[-1], scores)
        if not leaders or len(steps) == MOST:
            break
        trials = sorted((_trial(now, (score,), seed) for score in leaders), key=lambda trial: -trial.merit)
        accepted = trials[0] if trials[0].sound else _pair(now, trials, seed) or _in_company(now, trials[0], seed)
        plain = describe(now, generator("vocabulary of a step", seed, len(steps)))[0]
        if accepted is None or _outdone(accepted, plain, now):
            rejected = tuple(trials)
            break
        others = tuple(trial for trial in trials if trial is not accepted)
        steps.append(Step(accepted, (), others))
        now = _with_allowance(accepted)
    if steps:
        steps[-1] = _with_rivals(steps[-1], scores)
    return Closed(before, now.strict, now, tuple(steps), first, scores, rejected)


def _screened(fitted: Fitted, kinds: Sequence[type[Effect]], rng: np.random.Generator) -> tuple[Score, ...]:
    """The best hypothesis of every effect."""
    found = list(hypotheses(kinds))
    return tuple(best_of_kind(screen(found, signatures(found, fitted.model, fitted.measured), fitted, rng)))


def _leaders(scores: Sequence[Score]) -> list[Score]:
    """What is fitted: the best scores that are no luck, and those hardly worse than the very best."""
    real = [score for score in scores if score.chance <= ALPHA]
    nearly = [s for s in real[LEADERS:NEARLY_LEADERS] if s.gain > (1 - NEARLY) * real[0].gain]
    return [*real[:LEADERS], *nearly]


def _trial(now: Fitted, scores: tuple[Score, ...], seed: int) -> Trial:
    """Hypotheses added to the model and fitted with it."""
    rng = generator("zoom", seed, *(str(score.hypothesis) for score in scores))
    added = tuple(zoom(score, now, rng) for score in scores)
    known = len(now.model.effects)
    fitted = extended(now, added)
    effects = fitted.model.effects[known:]
    found = tuple(coherence(fitted, known + number) for number in range(len(added)))
    evidence = fitted.log_likelihood - now.log_likelihood
    return Trial(scores[0], effects, fitted, fitted.predictive - now.predictive, evidence, found)


def _pair(now: Fitted, trials: Sequence[Trial], seed: int) -> Trial | None:
    """Two effects that hide one another: the best pair with the best trial, if both members are sound together."""
    pairs = [_trial(now, (trials[0].score, other.score), seed) for other in trials[1:]]
    best = max(pairs, key=lambda pair: pair.merit, default=None)
    return best if best and best.sound and best.merit > trials[0].merit + 2 * PAIR_GAIN else None


def _in_company(now: Fitted, trial: Trial, seed: int) -> Trial | None:
    """The best trial, if its parts agree once a regularity that has nothing to do with it is taken out."""
    known = len(trial.fitted.model.effects) - len(trial.effects)
    before, after, explained = now, trial.fitted, trial.explained(now)
    for number in range(COMPANY):
        beside = describe(after, generator("company", seed, number))[0]
        before, after = set_free(before, beside), set_free(after, beside)
        if beside.chance > ALPHA or trial.explained(before) < max(ANOTHER_THING * explained, beside.gain):
            return None
        agreeing = replace(trial, coherence=tuple(coherence(after, known + i) for i in range(len(trial.effects))))
        if agreeing.sound:
            return agreeing
    return None


def _outdone(trial: Trial, plain: Described, now: Fitted) -> bool:
    """Whether a bare regularity explains what a trial explains, and more; or by far more of something else."""
    explained = trial.explained(now)
    if plain.gain <= explained * (1 + OUTDONE_SHARE) + OUTDONE:
        return False
    together = _gain(now, np.hstack([trial.signature, columns(plain.atom, now)]))
    return plain.gain > DWARFED * explained or together - plain.gain < SAME_THING * explained


def _gain(fitted: Fitted, columns: Float[np.ndarray, "row column"]) -> float:
    """Fall of a residual's sum of squares by columns of any size."""
    basis = np.linalg.qr(fitted.whole.whiten(columns))[0]
    return float(((basis.T @ fitted.whole.whiten(fitted.from_start)) ** 2).sum())


def _with_allowance(accepted: Trial) -> Fitted:
    """The fit of a trial, with its effects' form open within the tolerance."""
    fitted = accepted.fitted
    count = len(fitted.model.effects)
    open_ = [allowance(fitted, number) for number in range(count - len(accepted.effects), count)]
    kept = [] if fitted.allowed is None else [fitted.allowed]
    allowed = np.hstack([*kept, *open_])
    return replace(fitted, open=np.hstack([fitted.open, *open_]), allowed=allowed)


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
