"""The inner parameters of a hypothesis, no longer on a grid: zoomed in on by the score, with the real chain."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.quantity import Quantity, Role, quantities, size_of
from swgsim.identification.data.model import predict_with_others
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.search.hypotheses import Hypothesis, signatures
from swgsim.identification.search.screening import Score, rank

# Values on either side of the best one, and rounds; every round has a third of the range of the last one.
TRIED, GRID_ROUNDS = 2, 4
# An estimate holds if the chain keeps so much of the gain that the score promised; else the typical size is tried, and
# so many over the range, and then as many about the best of these.
LEAST_KEPT_GAIN, SIZES_TRIED = 0.5, 13
# Places around one that are tried, in spacings of the screening, each with so many times the size; and moves at most.
PLACE_STEPS, SIZE_FACTORS, MOVES = (-0.5, -0.25, 0.25, 0.5), (0.7, 1.0, 1.4), 6
# A size at least this share of its range from nothing; a smaller one has no signature above rounding.
LEAST_SIZE = 1e-3


def zoom(score: Score, fitted: Fitted) -> Effect:
    """The effect of a score at its likeliest inner parameters and size, for a fit to begin with.

    The signature is taken at the size that was found last, as that of a crack is far from proportional to its size.
    """
    declared = quantities(score.hypothesis.kind)
    another = fitted.unit.of_another_structure
    searched = [name for name, q in declared.items() if q.role in (Role.ANGLE, Role.SHAPE) and q.open(another)]
    best = score
    reach = {name: spacing(declared[name]) for name in searched}
    for _ in range(GRID_ROUNDS if searched else 1):
        offsets = product(*[np.linspace(-1, 1, 2 * TRIED + 1) * reach[name] for name in searched])
        around = [_moved(best, dict(zip(searched, offset, strict=True)), declared) for offset in offsets]
        best = rank(around, signatures(around, fitted.model, fitted.measured), fitted)[0]
        reach = {name: by / 3 for name, by in reach.items()}
    if not np.isfinite(best.estimate):
        best = score
    return _at_its_place(_at_its_size(best, declared[score.hypothesis.size], fitted), fitted)


def _at_its_size(score: Score, quantity: Quantity, fitted: Fitted) -> Effect:
    """The effect of a score: of the estimated size, or of the likeliest one where the chain disproves the estimate."""

    def effects(sizes: Sequence[float]) -> list[Effect]:
        phase = score.phase if np.isfinite(score.phase) else 0.0
        return [score.hypothesis.effect(size, phase) for size in sizes]

    r = fitted.white
    estimated = effects([score.estimate])
    # A size that changes nothing has no gain, and rounding would make a fall of it.
    if 0 < LEAST_KEPT_GAIN * score.gain < float(r @ r) - _left(fitted, estimated)[0]:
        return estimated[0]
    spaced = np.geomspace if quantity.low > 0 else np.linspace
    least = LEAST_SIZE * (quantity.high - quantity.low)
    grid = spaced(quantity.low, quantity.high, SIZES_TRIED)
    coarse = [size for size in (quantity.typical, *grid.tolist()) if abs(size - quantity.nothing) > least]
    best = coarse[int(_left(fitted, effects(coarse)).argmin())]
    below = grid[grid < best - least].max(initial=quantity.low)
    above = grid[grid > best + least].min(initial=quantity.high)
    fine = [size for size in np.linspace(below, above, SIZES_TRIED).tolist() if abs(size - quantity.nothing) > least]
    tried = [*estimated, *effects([best, *fine])]
    return tried[int(_left(fitted, tried).argmin())]


def _at_its_place(effect: Effect, fitted: Fitted) -> Effect:
    """The effect at the likeliest place around, by the chain.

    Where a place acts in steps, as that of a crack does from gap to gap of the mesh, no fit can move it; and another
    size, which the signature of a curved effect may take, makes the wrong place look as good.
    """
    declared = quantities(type(effect))
    places, size = [name for name, q in declared.items() if q.role is Role.ANGLE], size_of(type(effect))
    q = declared[size]
    for _ in range(MOVES if places else 0):
        here = getattr(effect, size) - q.nothing
        sizes = [float(np.clip(q.nothing + factor * here, q.low, q.high)) for factor in SIZE_FACTORS]
        moved = [
            replace(effect, **{name: float((getattr(effect, name) + step * spacing(declared[name])) % (2 * np.pi))})
            for name in places
            for step in PLACE_STEPS
        ]
        around = [effect, *(replace(each, **{size: to}) for each in (effect, *moved) for to in sizes)]
        before, effect = effect, around[int(_left(fitted, around).argmin())]
        if effect is before:
            break
    return effect


def _left(fitted: Fitted, effects: Sequence[Effect]) -> Float[np.ndarray, " effect"]:
    """Sum of squares of the weighed residual that each effect leaves, by the chain."""
    left = (fitted.whole.whiten(fitted.from_start[:, None] - changes(fitted, effects)) ** 2).sum(axis=0)
    return np.where(np.isfinite(left), left, np.inf)


def changes(fitted: Fitted, effects: Sequence[Effect]) -> Float[np.ndarray, "row effect"]:
    """What each effect does to the features, by the chain; nan if the gear has no steady state with it."""
    models = [fitted.model.plus(effect) for effect in effects]
    predicted, beside = predict_with_others(fitted.model, models, fitted.measured.situations, fitted.measured.layout)
    return fitted.measured.rows(np.moveaxis(beside - predicted, 0, -1))


def spacing(quantity: Quantity) -> float:
    """Distance of the values that the screening tried."""
    return (quantity.high - quantity.low) / max(quantity.points, 2)


def _moved(score: Score, by: dict[str, float], declared: Mapping[str, Quantity]) -> Hypothesis:
    """A hypothesis with inner parameters moved, linearised about the size that was found."""
    hypothesis, inner = score.hypothesis, dict(score.hypothesis.inner)
    for name, step in by.items():
        q = declared[name]
        value = inner[name] + step
        inner[name] = float(value % (2 * np.pi) if q.role is Role.ANGLE else np.clip(value, q.low, q.high))
    q = declared[hypothesis.size]
    found = score.estimate if np.isfinite(score.estimate) else q.typical
    if abs(found - q.nothing) < LEAST_SIZE * (q.high - q.low):
        found = q.nothing + np.copysign(LEAST_SIZE * (q.high - q.low), found - q.nothing or q.typical - q.nothing)
    return replace(hypothesis, inner=tuple(inner.items()), reference=float(found))
