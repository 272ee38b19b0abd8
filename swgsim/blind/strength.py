"""How strong an effect is: non-centrality of its signature once the declared parameters are projected out."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from swgsim.effects.base import Effect
from swgsim.effects.quantity import Quantity, quantities, size_of
from swgsim.loop.between import between
from swgsim.loop.fitting import Fitted
from swgsim.loop.hypotheses import hypotheses, signatures
from swgsim.loop.model import predict
from swgsim.loop.sidelines import is_random

# Shares of the way from nothing to the bound at which the strength is tried, and how far at most.
FARTHEST, COARSE, FINE = 0.9, 13, 5


def strengths(effects: Sequence[Effect], of: Sequence[type[Effect]], fitted: Fitted) -> np.ndarray:
    """Non-centrality of every effect, without any noise.

    Parameters
    ----------
    effects : sequence of Effect
        As they act, altered or not.
    of : sequence of effect classes
        What each of them is.
    fitted : Fitted
        The loop's fit to the same recordings without them.
    """
    found = np.zeros(len(effects))
    chain = [i for i, kind in enumerate(of) if not is_random(kind)]
    if chain:
        models = [fitted.model, *(fitted.model.plus(effects[i]) for i in chain)]
        seen = predict(models, fitted.measured.situations, fitted.measured.layout)
        for i, changed in zip(chain, seen[1:], strict=True):
            found[i] = (fitted.whole.whiten(fitted.measured.rows(changed - seen[0])) ** 2).sum()
    for i in set(range(len(effects))) - set(chain):
        found[i] = sum((each.pattern(effects[i])[0] ** 2).sum() for each in between(fitted.measured.recordings))
    return found


def sized(
    effect: Effect, target: float, fitted: Fitted, dressed: Callable[[Effect], Effect] = lambda effect: effect
) -> tuple[Effect, float]:
    """An effect of the size that has a strength, as near as its bounds allow, and the strength it has then.

    Parameters
    ----------
    effect : Effect
        Its size says only to which side of nothing it is to lie.
    target : float
    fitted : Fitted
    dressed : callable
        The effect as it acts.
    """
    name = size_of(type(effect))
    quantity = quantities(type(effect))[name]
    upward = getattr(effect, name) > quantity.nothing

    def of(shares: np.ndarray) -> tuple[list[Effect], np.ndarray]:
        sizes = [_on_the_way(quantity, float(share), upward) for share in shares]
        tried = [replace(effect, **{name: value}) for value in sizes]
        return tried, strengths([dressed(each) for each in tried], [type(effect)] * len(tried), fitted)

    shares = np.geomspace(1e-5, FARTHEST, COARSE)
    tried, found = of(shares)
    above = np.flatnonzero(found >= target)
    if len(above) and above[0] > 0:
        first = above[0]
        shares = np.geomspace(shares[first - 1], shares[first], FINE)
        tried, found = of(shares)
        # Between two of them strength goes with some power of the size.
        ends = np.searchsorted(np.maximum.accumulate(found), target)
        low, high = max(int(ends) - 1, 0), min(int(ends), FINE - 1)
        logs = np.log(np.maximum(found, 1e-12))
        part = 0.5 if logs[high] <= logs[low] else (np.log(target) - logs[low]) / (logs[high] - logs[low])
        tried, found = of(np.array([shares[low] * (shares[high] / shares[low]) ** float(np.clip(part, 0, 1))]))
        return tried[0], float(found[0])
    nearest = 0 if len(above) else len(shares) - 1
    return tried[nearest], float(found[nearest])


def _on_the_way(quantity: Quantity, share: float, upward: bool) -> float:
    """A size some share of the way from nothing to a bound; in ratios where nothing is a ratio of one."""
    bound = quantity.high if upward else quantity.low
    if quantity.nothing > 0 and bound > 0:
        return float(quantity.nothing * (bound / quantity.nothing) ** share)
    return float(quantity.nothing + share * (bound - quantity.nothing))


def likeness(effect: Effect, library: Sequence[type[Effect]], fitted: Fitted) -> tuple[float, str]:
    """The largest share of an effect's projected signature that one effect of a library reproduces, and which one."""
    if is_random(type(effect)):
        return 0.0, ""
    model, measured = fitted.model, fitted.measured
    seen = predict([model, model.plus(effect)], measured.situations, measured.layout)
    own = fitted.whole.whiten(measured.rows(seen[1] - seen[0]))
    found = list(hypotheses(library))
    best, nearest = 0.0, ""
    for hypothesis, signature in zip(found, signatures(found, model, measured), strict=True):
        white = fitted.whole.whiten(signature)
        fit = np.linalg.lstsq(white, own, rcond=1e-9)[0]
        share = 1 - float(((own - white @ fit) ** 2).sum() / max((own**2).sum(), 1e-300))
        if share > best:
            best, nearest = share, hypothesis.kind.name()
    return best, nearest
