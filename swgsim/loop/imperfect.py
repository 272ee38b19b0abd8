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

from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities, size_of
from swgsim.loop.evidence import FORM_TOLERANCE, NO_SIZE, parts, powers
from swgsim.loop.fitted import Fitted
from swgsim.loop.fitting import unbent
from swgsim.loop.hypotheses import Hypothesis, signatures
from swgsim.loop.leading import ALPHA, LEADERS, NEARLY, offered
from swgsim.loop.refining import changes, spacing
from swgsim.loop.screening import Score
from swgsim.loop.trial import Trial, gained, tried
from swgsim.loop.vocabulary import freed, regularities, strongest
from swgsim.seeds import generator

# No more of an effect in its own form can be seen than its form may differ by, as a share of its sum of squares.
ABSORBED = FORM_TOLERANCE**2
# Multiples of the typical size of which the likeliest is sought, and of the size that was found last.
SIZES, FACTORS = np.geomspace(0.1, 10, 9), (0.5, 0.7, 0.85, 1.2, 1.4, 2.0)
# Phases of a wave that are tried. A phase, place or shape moves by half of the spacing of what was tried, and by half
# of that where no move is likelier, so many times; moves at most.
PHASES, HALVED, MOVES = 12, 3, 20
# Directions below this share of the largest variance are rounding.
ROUNDING = 1e-9


class Loose(NamedTuple):
    """A hypothesis with its form open: how much likelier it makes the residual, at so many times its typical size."""

    hypothesis: Hypothesis
    evidence: float
    times: float


def imperfect(now: Fitted, scores: Sequence[Score], seed: int) -> tuple[Trial, ...]:
    """Effects that in an imperfect form tell all that is missing, and are likelier than bare regularities; best first.

    Parameters
    ----------
    now : Fitted
        A model of which no effect in its own form explains what it lacks, if it lacks anything.
    scores : sequence of Score
        The best of each effect.
    seed : int
    """
    absorbed = {score.hypothesis.kind: score for score in scores if score.visible < ABSORBED}
    unknown = regularities(now, seed) if absorbed else ()
    if not unknown:
        return ()
    _, described = gained(now, reduce(freed, unknown, now))
    start = unbent(now)
    loose = _screened(start, list(absorbed))
    least = max(described, (1 - NEARLY) * loose[0].evidence)
    tried_ = (
        _tried(now, start, absorbed[each.hypothesis.kind], each) for each in loose[:LEADERS] if each.evidence > least
    )
    found = [t for t in tried_ if t and t.sound and t.evidence > described and _tells_all(t, seed)]
    return tuple(sorted(found, key=lambda trial: -trial.evidence))


def _tells_all(trial: Trial, seed: int) -> bool:
    """Whether no regularity is left beside a trial."""
    return strongest(trial.fitted, generator("beside an imperfect form", seed)).chance > ALPHA


def _tried(now: Fitted, start: Fitted, score: Score, loose: Loose) -> Trial | None:
    """A hypothesis fitted with its form open; none if it is smaller after all than what its form was opened for, as
    then not the effect explains something but only how its form differs.
    """
    effect = _zoomed(start, loose)
    (change,) = changes(start, [effect]).T
    trial = tried(now, score, (effect,), start.allowing(_imperfections(start, change)))
    size = size_of(type(effect))
    nothing = quantities(type(effect))[size].nothing
    kept = (getattr(trial.effects[0], size) - nothing) / (getattr(effect, size) - nothing)
    return replace(trial, imperfect=True) if kept > NO_SIZE else None


def _imperfections(fitted: Fitted, signature: Float[np.ndarray, " row"]) -> Float[np.ndarray, "row form"]:
    """By what a signature may differ from the library's form, one standard deviation each."""
    return FORM_TOLERANCE * np.hstack([parts(fitted, signature), powers(fitted, signature)])


def _screened(fitted: Fitted, kinds: Sequence[type[Effect]]) -> list[Loose]:
    """The likeliest hypothesis of every kind, the likeliest first."""
    found = offered(fitted, kinds)
    r = fitted.whole.whiten(fitted.from_start)
    signed = signatures(found, fitted.model, fitted.measured)
    loose = [_loose(fitted, *each, r) for each in zip(found, signed, strict=True)]
    best: dict[type[Effect], Loose] = {}
    for each in sorted(loose, key=lambda each: -each.evidence):
        best.setdefault(each.hypothesis.kind, each)
    return list(best.values())


def _loose(
    fitted: Fitted,
    hypothesis: Hypothesis,
    signature: Float[np.ndarray, "row column"],
    r: Float[np.ndarray, " row"],
) -> Loose:
    """A hypothesis at its likeliest size, either sign and any phase being as likely."""
    q = quantities(hypothesis.kind)[hypothesis.size]
    most = max(q.high - q.nothing, q.nothing - q.low) / abs(hypothesis.typical - q.nothing)
    times = np.unique(np.minimum(SIZES, most))
    open_ = np.hstack([signature, *(_imperfections(fitted, column) for column in signature.T)])
    s2, along = _directions(fitted.whole.whiten(open_), r)
    wider = times[:, None] ** 2 * s2
    evidence = (along**2 * wider / (1 + wider) - np.log1p(wider)).sum(axis=1) / 2
    return Loose(hypothesis, float(evidence.max()), float(times[evidence.argmax()]))


def _directions(
    columns: Float[np.ndarray, "row column"], r: Float[np.ndarray, " row"]
) -> tuple[Float[np.ndarray, " direction"], Float[np.ndarray, " direction"]]:
    """Variances that columns make along their own directions, and what a residual has along these."""
    s2, V = np.linalg.eigh(columns.T @ columns)
    kept = s2 > ROUNDING * max(float(s2[-1]), np.finfo(float).tiny)
    return s2[kept], (V[:, kept].T @ (columns.T @ r)) / np.sqrt(s2[kept])


def _zoomed(fitted: Fitted, loose: Loose) -> Effect:
    """The effect of a hypothesis at its likeliest size, phase and place, its form being open."""
    around, step, likeliest = list(_anywhere(loose)), 0.5, -np.inf
    effect = around[0]
    for _ in range(MOVES):
        found = _log_likelihoods(fitted, around)
        if found.max() > likeliest:
            effect, likeliest = around[int(found.argmax())], float(found.max())
        elif (step := step / 2) < 0.5 / 2**HALVED:
            break
        around = list(_moved(effect, step, fitted.unit.of_another_structure))
    return effect


def _anywhere(loose: Loose) -> Iterator[Effect]:
    """The effect of a hypothesis, of either sign and at any phase."""
    hypothesis = loose.hypothesis
    q = quantities(hypothesis.kind)[hypothesis.size]
    by = loose.times * (hypothesis.typical - q.nothing)
    sizes = {float(np.clip(size, q.low, q.high)) for size in (q.nothing + by, q.nothing - by)}
    for size in sorted(sizes - {q.nothing}):
        for phase in 2 * np.pi * np.arange(PHASES if hypothesis.phase else 1) / PHASES:
            yield hypothesis.effect(size, float(phase))


def _moved(effect: Effect, step: float, another_structure: bool) -> Iterator[Effect]:
    """An effect with one of its parameters moved."""
    for name, q in quantities(type(effect)).items():
        here = getattr(effect, name)
        if q.role is Role.SIZE:
            to = [q.nothing + times * (here - q.nothing) for times in FACTORS]
        elif q.role is Role.PHASE:
            to = [here + turn * 2 * np.pi / PHASES for turn in (-step, step)]
        elif q.role is Role.ANGLE:
            to = [(here + turn * spacing(q)) % (2 * np.pi) for turn in (-step, step)]
        elif q.role is Role.SHAPE and q.open(another_structure):
            to = [here + turn * spacing(q) for turn in (-step, step)]
        else:
            to = []
        bounded = q.role in (Role.SIZE, Role.SHAPE)
        yield from (replace(effect, **{name: float(np.clip(v, q.low, q.high) if bounded else v)}) for v in to)


def _log_likelihoods(fitted: Fitted, effects: Sequence[Effect]) -> Float[np.ndarray, " effect"]:
    """Of the residual beside each effect with its form open, without what is the same for all."""
    done = changes(fitted, effects)
    left = fitted.whole.whiten(fitted.from_start[:, None] - done)
    found = []
    for r, change in zip(left.T, done.T, strict=True):
        s2, along = _directions(fitted.whole.whiten(_imperfections(fitted, change)), r)
        found.append(float((along**2 * s2 / (1 + s2) - np.log1p(s2)).sum() - r @ r) / 2)
    return np.array(found)
