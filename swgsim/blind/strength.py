"""Strength of an effect: non-centrality of its signature, with nuisance parameters fitted or marginalised."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from swgsim.effects.base import Effect
from swgsim.effects.quantity import Quantity, quantities, size_of
from swgsim.identification.data.model import predict
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.map_fit import calibrate
from swgsim.identification.interharmonics.interharmonic_spectrum import gauge_spectra
from swgsim.identification.interharmonics.named_interharmonics import is_random
from swgsim.identification.search.hypotheses import hypotheses, signatures

# Shares of the way from nothing to the bound at which the strength is tried, and how far at most.
FARTHEST_SHARE, COARSE, FINE = 0.9, 13, 5
# Largest deviation of the strength with fitted parameters from the planned one.
STRENGTH_TOLERANCE = 0.03


def strengths(effects: Sequence[Effect], of: Sequence[type[Effect]], fitted: Fitted) -> np.ndarray:
    """Non-centrality of every effect, without any noise, beside declared parameters that are fitted to it.

    Beside their derivatives alone, a drop of k1 within its spread would be strong, as it is no multiple of that by k1.

    Parameters
    ----------
    effects : sequence of Effect
        As they act, altered or not.
    of : sequence of effect classes
        What each of them is.
    fitted : Fitted
        The loop's fit to the same recordings without them.
    """
    found = _linear(effects, of, fitted)
    for i, kind in enumerate(of):
        if fitted.parameters and not is_random(kind):
            found[i] = _calibrated(effects[i], fitted)
    return found


def _linear(effects: Sequence[Effect], of: Sequence[type[Effect]], fitted: Fitted) -> np.ndarray:
    """Non-centrality of every effect, with declared parameters linearised."""
    found = np.zeros(len(effects))
    chain = [i for i, kind in enumerate(of) if not is_random(kind)]
    if chain:
        models = [fitted.model, *(fitted.model.plus(effects[i]) for i in chain)]
        seen = predict(models, fitted.measured.situations, fitted.measured.layout)
        for i, changed in zip(chain, seen[1:], strict=True):
            found[i] = (fitted.whole.whiten(fitted.measured.rows(changed - seen[0])) ** 2).sum()
    spectra = gauge_spectra(fitted.measured.recordings, fitted.model.gear.transmission.N)
    for i in set(range(len(effects))) - set(chain):
        found[i] = sum((each.pattern(effects[i])[0] ** 2).sum() for each in spectra)
    return found


def _calibrated(effect: Effect, fitted: Fitted) -> float:
    """Sum of squares of an effect beside the likeliest parameters without it, and of what these are off."""
    measured = fitted.measured
    changed = predict([fitted.model.plus(effect)], measured.situations, measured.layout)[0]
    errors = fitted.of_nuisances
    found = calibrate(
        fitted.model, fitted.parameters, changed[measured.of_recording], errors,
        measured.situations, measured.of_recording, measured.layout,
    )  # fmt: skip
    left = errors.whiten(measured.rows(changed - found.predicted))
    return float(left @ left + np.square(list(found.position.values())).sum())


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

    def at(share: float) -> Effect:
        return replace(effect, **{name: _on_the_way(quantity, share, upward)})

    def linear(shares: np.ndarray) -> np.ndarray:
        return _linear([dressed(at(share)) for share in shares.tolist()], [type(effect)] * len(shares), fitted)

    def strength(share: float) -> float:
        return float(strengths([dressed(at(share))], [type(effect)], fitted)[0])

    def short_of(log_share: float) -> float:
        return float(np.log(target / max(strength(np.exp(log_share)), 1e-12)))

    share = _share(linear, target)
    found = strength(share)
    if share < FARTHEST_SHARE and found < (1 - STRENGTH_TOLERANCE) * target:
        share, near, found = FARTHEST_SHARE, share, strength(FARTHEST_SHARE)
        if found > target:
            # Strength goes with the square of a small size.
            share = np.exp(brentq(short_of, np.log(near), np.log(FARTHEST_SHARE), xtol=STRENGTH_TOLERANCE / 2))
            found = strength(share)
    return at(share), found


def _share(linear: Callable[[np.ndarray], np.ndarray], target: float) -> float:
    """The share of the way to the bound at which a strength that grows is as planned, or the nearest to it."""
    shares = np.geomspace(1e-5, FARTHEST_SHARE, COARSE)
    above = np.flatnonzero(linear(shares) >= target)
    if not len(above) or above[0] == 0:
        return float(shares[0 if len(above) else -1])
    shares = np.geomspace(shares[above[0] - 1], shares[above[0]], FINE)
    found = linear(shares)
    # Between two of them strength goes with some power of the size.
    ends = np.searchsorted(np.maximum.accumulate(found), target)
    low, high = max(int(ends) - 1, 0), min(int(ends), FINE - 1)
    logs = np.log(np.maximum(found, 1e-12))
    part = 0.5 if logs[high] <= logs[low] else (np.log(target) - logs[low]) / (logs[high] - logs[low])
    return float(shares[low] * (shares[high] / shares[low]) ** float(np.clip(part, 0, 1)))


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
