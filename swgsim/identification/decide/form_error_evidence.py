"""Effects in an imperfect form, sought where none in its own form is what the model lacks.

What a gear leaves open may absorb nearly all that an effect does in the form that the library has of it. Seen is then
only by what nature differs from that form, and this looks like another effect, or like none. So effects are compared by
how likely they make the residual if their parts, and the power of load and speed that they go with, differ from the
library's as the tolerance of form allows.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import reduce
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.common.seeds import generator
from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities, size_of
from swgsim.identification.decide.candidate import Trial, gained, tried
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import extended, unbent
from swgsim.identification.fit.form_error import FORM_TOLERANCE, NO_SIZE, coherence, parts, powers
from swgsim.identification.search.hypotheses import signatures
from swgsim.identification.search.refining import changes, spacing
from swgsim.identification.search.regularities import freed, regularities, strongest
from swgsim.identification.search.screening import Score, rank
from swgsim.identification.search.shortlist import ALPHA, LEADERS, NEARLY, offered

# No more of an effect in its own form can be seen than its form may differ by, as a share of its sum of squares.
ABSORBED = FORM_TOLERANCE**2
# Multiples of the typical size of which the likeliest is sought, and of the size that was found last.
SIZES, FACTORS = np.geomspace(0.1, 10, 9), np.array([0.5, 0.7, 0.85, 1.2, 1.4, 2.0])
# Phases of a wave that are tried. A phase, place or shape moves by this share of the spacing of what was tried; it is
# halved so many times where no move is likelier; moves at most.
PHASES, STEP, HALVED, MOVES = 12, 0.5, 3, 20
# What a place between those that were tried, and the fit, add to the evidence (an estimate).
ADDED = 8.0
# Directions below this share of the largest variance are rounding.
LEAST_VARIANCE = 1e-9


class Opened(NamedTuple):
    """A hypothesis with its form open: how much likelier it makes the residual, at so many times its typical size."""

    score: Score
    evidence: float
    times: float


def imperfect(now: Fitted, kinds: Sequence[type[Effect]], seed: int) -> tuple[Trial, ...]:
    """Effects that in an imperfect form tell all that is missing, and are likelier than bare regularities; best first.

    What regularities cost by being free to be large stands for how many there are to choose from.

    Parameters
    ----------
    now : Fitted
        A model of which no effect in its own form explains what it lacks, if it lacks anything.
    kinds : sequence of effect classes
        The library.
    seed : int
    """
    unknown = () if now.unit.commissioned else regularities(now, seed)
    if not unknown:
        return ()
    _, described = gained(now, reduce(freed, unknown, now))
    start = unbent(now)
    opened = _screened(start, kinds)
    best = max((each.evidence for each in opened), default=0.0)
    least = max(described, best - max(NEARLY * best, ADDED))
    trials = (_tried(now, start, each) for each in opened[:LEADERS] if each.evidence > least)
    found = [t for t in trials if t and t.sound and t.evidence > described and _tells_all(t, seed)]
    return tuple(sorted(found, key=lambda trial: -trial.evidence))


def _tells_all(trial: Trial, seed: int) -> bool:
    """Whether no regularity is left beside a trial."""
    return strongest(trial.fitted, generator("beside an imperfect form", seed)).chance > ALPHA


def _tried(now: Fitted, start: Fitted, opened: Opened) -> Trial | None:
    """A hypothesis fitted with its form open.

    None if less than half is left of the size that it was opened for: then not the effect explains something, but only
    how its form differs.
    """
    effect = _zoomed(start, opened)
    (change,) = changes(start, [effect]).T
    if not change.any():
        return None
    trial = tried(now, opened.score, (effect,), start.allowing(_imperfections(start, change)))
    size = size_of(type(effect))
    nothing = quantities(type(effect))[size].nothing
    if (getattr(trial.effects[0], size) - nothing) / (getattr(effect, size) - nothing) < NO_SIZE:
        return None
    # Whether its parts agree is told beside its open form; how they differ, and what doubt that leaves, without.
    (open_,), in_its_own = trial.coherence, extended(trial.fitted.strict, ())
    differing = coherence(in_its_own, len(in_its_own.model.effects) - 1)
    agreement = replace(differing, chance=open_.chance, disagreement=open_.disagreement)
    return replace(trial, coherence=(agreement,), imperfect=True)


def _imperfections(fitted: Fitted, signature: Float[np.ndarray, " row"]) -> Float[np.ndarray, "row form"]:
    """By what a signature may differ from the library's form, one standard deviation each."""
    return FORM_TOLERANCE * np.hstack([parts(fitted, signature), powers(fitted, signature)])


def _screened(fitted: Fitted, kinds: Sequence[type[Effect]]) -> list[Opened]:
    """The likeliest hypothesis of every kind of those that are absorbed in their own form, the likeliest first."""
    found = offered(fitted, kinds)
    signed = dict(zip(found, signatures(found, fitted.model, fitted.measured), strict=True))
    r = fitted.whole.whiten(fitted.from_start)
    scores = [score for score in rank(found, list(signed.values()), fitted) if 0 < score.visible < ABSORBED]
    opened = [_opened(fitted, score, signed[score.hypothesis], r) for score in scores]
    best: dict[type[Effect], Opened] = {}
    for each in sorted(opened, key=lambda each: -each.evidence):
        best.setdefault(each.score.hypothesis.kind, each)
    return list(best.values())


def _opened(
    fitted: Fitted, score: Score, signature: Float[np.ndarray, "row column"], r: Float[np.ndarray, " row"]
) -> Opened:
    """A hypothesis at its likeliest size, either sign and any phase being as likely."""
    hypothesis = score.hypothesis
    q = quantities(hypothesis.kind)[hypothesis.size]
    most = max(q.high - q.nothing, q.nothing - q.low) / abs(hypothesis.typical - q.nothing)
    times = np.unique(np.minimum(SIZES, most))
    open_ = np.hstack([signature, *(_imperfections(fitted, column) for column in signature.T)])
    s2, along = _directions(fitted.whole.whiten(open_), r)
    wider = times[:, None] ** 2 * s2
    evidence = (along**2 * wider / (1 + wider) - np.log1p(wider)).sum(axis=1) / 2
    return Opened(score, float(evidence.max()), float(times[evidence.argmax()]))


def _directions(
    columns: Float[np.ndarray, "row column"], r: Float[np.ndarray, " row"]
) -> tuple[Float[np.ndarray, " direction"], Float[np.ndarray, " direction"]]:
    """Variances that columns make along their own directions, and what a residual has along these."""
    s2, V = np.linalg.eigh(columns.T @ columns)
    kept = s2 > LEAST_VARIANCE * max(float(s2[-1]), np.finfo(float).tiny)
    return s2[kept], (V[:, kept].T @ (columns.T @ r)) / np.sqrt(s2[kept])


def _zoomed(fitted: Fitted, opened: Opened) -> Effect:
    """The effect of a hypothesis at its likeliest size, phase and place, its form being open."""
    around, step, likeliest = list(_anywhere(opened)), STEP, -np.inf
    effect = around[0]
    for _ in range(MOVES):
        found = _log_likelihoods(fitted, around)
        if found.max() > likeliest:
            effect, likeliest = around[int(found.argmax())], float(found.max())
        elif (step := step / 2) < STEP / 2**HALVED:
            break
        around = list(_around(effect, step, fitted.unit.of_another_structure))
    return effect


def _anywhere(opened: Opened) -> Iterator[Effect]:
    """The effect of a hypothesis, of either sign and at any phase."""
    hypothesis = opened.score.hypothesis
    q = quantities(hypothesis.kind)[hypothesis.size]
    by = opened.times * (hypothesis.typical - q.nothing)
    sizes = {float(np.clip(size, q.low, q.high)) for size in (q.nothing + by, q.nothing - by)}
    for size in sorted(sizes - {q.nothing}):
        for phase in 2 * np.pi * np.arange(PHASES if hypothesis.phase else 1) / PHASES:
            yield hypothesis.effect(size, float(phase))


def _around(effect: Effect, step: float, another_structure: bool) -> Iterator[Effect]:
    """An effect with one of its parameters moved."""
    for name, q in quantities(type(effect)).items():
        here, turns = getattr(effect, name), np.array([-step, step])
        if q.role is Role.SIZE:
            to = np.clip(q.nothing + FACTORS ** (step / STEP) * (here - q.nothing), q.low, q.high)
        elif q.role is Role.PHASE:
            to = (here + turns * 2 * np.pi / PHASES) % (2 * np.pi)
        elif q.role is Role.ANGLE:
            to = (here + turns * spacing(q)) % (2 * np.pi)
        elif q.role is Role.SHAPE and q.open(another_structure):
            to = np.clip(here + turns * spacing(q), q.low, q.high)
        else:
            to = np.zeros(0)
        yield from (replace(effect, **{name: value}) for value in to.tolist())


def _log_likelihoods(fitted: Fitted, effects: Sequence[Effect]) -> Float[np.ndarray, " effect"]:
    """Of the residual beside each effect with its form open, without what is the same for all; -inf where the chain has
    no answer.
    """
    done = changes(fitted, effects)
    found = np.full(len(effects), -np.inf)
    for i in np.flatnonzero(np.isfinite(done).all(axis=0)):
        r = fitted.whole.whiten(fitted.from_start - done[:, i])
        s2, along = _directions(fitted.whole.whiten(_imperfections(fitted, done[:, i])), r)
        found[i] = ((along**2 * s2 / (1 + s2) - np.log1p(s2)).sum() - r @ r) / 2
    return found
