"""The inner parameters of a hypothesis, no longer on a grid: zoomed in on by the score, with the real chain."""

from dataclasses import replace
from itertools import product

import numpy as np

from swgsim.effects.base import Effect
from swgsim.effects.quantity import Quantity, Role, quantities
from swgsim.loop.fitting import Fitted
from swgsim.loop.hypotheses import Hypothesis, signatures
from swgsim.loop.model import predict
from swgsim.loop.screening import Score, screen

# Values that are tried beside the best one, and rounds; every round looks at a third of the last one's reach.
TRIED, ROUNDS = 2, 4
# Sizes over the range that are tried beside the one found, for effects far from proportional to their size.
SIZES = 13
# A size at least this share of its range from nothing; a smaller one has no signature above rounding.
LEAST = 1e-3


def zoom(score: Score, fitted: Fitted, rng: np.random.Generator) -> Effect:
    """The effect of a score at its likeliest inner parameters and size, for a fit to begin with.

    The signature is taken at the size that was found last, as that of a crack is far from proportional to its size.
    """
    declared = quantities(score.hypothesis.kind)
    searched = [name for name, q in declared.items() if q.role in (Role.ANGLE, Role.SHAPE) and q.points > 1]
    best = score
    reach = {name: _spacing(declared[name]) for name in searched}
    for _ in range(ROUNDS if searched else 1):
        offsets = product(*[np.linspace(-1, 1, 2 * TRIED + 1) * reach[name] for name in searched])
        around = [_moved(best, dict(zip(searched, offset, strict=True)), declared) for offset in offsets]
        best = screen(around, signatures(around, fitted.model, fitted.measured), fitted, rng)[0]
        reach = {name: by / 3 for name, by in reach.items()}
    if not np.isfinite(best.estimate):
        best = score
    return _likeliest_size(best, declared[score.hypothesis.size], fitted)


def _likeliest_size(score: Score, quantity: Quantity, fitted: Fitted) -> Effect:
    """The effect of a score at the size with which the chain leaves least of the residual."""
    spaced = np.geomspace if quantity.low > 0 else np.linspace
    sizes = [score.estimate, quantity.typical, *spaced(quantity.low, quantity.high, SIZES).tolist()]
    effects = [score.hypothesis.effect(size, score.phase if np.isfinite(score.phase) else 0.0) for size in sizes]
    models = [fitted.model, *(fitted.model.plus(effect) for effect in effects)]
    predicted = predict(models, fitted.measured.situations, fitted.measured.layout)
    changes = fitted.measured.rows(np.moveaxis(predicted[1:] - predicted[0], 0, -1))
    left = fitted.whole.whiten(fitted.from_start[:, None] - changes)
    return effects[int((left**2).sum(axis=0).argmin())]


def _spacing(quantity: Quantity) -> float:
    """Distance of the values that the screening tried."""
    return (quantity.high - quantity.low) / max(quantity.points, 2)


def _moved(score: Score, by: dict[str, float], declared: dict[str, Quantity]) -> Hypothesis:
    """A hypothesis with inner parameters moved, linearised about the size that was found."""
    hypothesis, inner = score.hypothesis, dict(score.hypothesis.inner)
    for name, step in by.items():
        q = declared[name]
        value = inner[name] + step
        inner[name] = float(value % (2 * np.pi) if q.role is Role.ANGLE else np.clip(value, q.low, q.high))
    q = declared[hypothesis.size]
    found = score.estimate if np.isfinite(score.estimate) else q.typical
    if abs(found - q.nothing) < LEAST * (q.high - q.low):
        found = q.nothing + np.copysign(LEAST * (q.high - q.low), found - q.nothing or q.typical - q.nothing)
    return replace(hypothesis, inner=tuple(inner.items()), reference=float(found))
