"""Lines between the integer orders: a bearing's cage and balls, the mains, sub-harmonics. Their phase is another one in
every recording, so the model cannot predict them; their power and their pattern over the gauges can be tested.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from scipy.stats import chi2, f

from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities, size_of
from swgsim.loop.between import Between, between
from swgsim.loop.tail import log_tail
from swgsim.recording import Recording

# A line's size may differ from its law over load and speed by this share.
TOLERANCE = 0.3
CONTRADICTION = 1e-4
ZOOMS = 3
# The noise beside a line is what was estimated of all lines together, as so many numbers would say it.
ALL_TOGETHER = 20
# Effects that are added at most.
MOST = 3


@dataclass(frozen=True)
class Sideline:
    """An effect with random phases, beside what the recordings hold of it.

    Attributes
    ----------
    effect : Effect
        At its estimated size; its phases mean nothing.
    gain : float
        Sum of squares that it explains, in units of the noise beside its lines.
    freedom : int
        Numbers that this fits: a cosine and a sine per recording and independent phase.
    chance : float
        Probability of as much by noise anywhere in the library.
    deviation : float
        Standard deviation of the size.
    agrees : float
        Probability that recordings differ so much from the effect's law, if that is right to TOLERANCE.
    """

    effect: Effect
    gain: float
    freedom: int
    chance: float
    deviation: float
    agrees: float

    @property
    def rank(self) -> float:
        """How unlikely the gain is by luck."""
        return -2 * float(log_tail(self.gain, self.freedom))

    @property
    def holds(self) -> bool:
        """Whether all recordings follow the effect's law."""
        return self.agrees > CONTRADICTION


def search(
    recordings: Sequence[Recording], kinds: Iterable[type[Effect]], level: float
) -> tuple[list[Sideline], list[Between]]:
    """Effects between the orders, one after the other as long as one is too unlikely to be luck; and what they leave.

    Parameters
    ----------
    recordings : sequence of Recording
    kinds : iterable of effect classes
    level : float
        Probability of a false one.
    """
    spectra = between(recordings)
    found: list[Sideline] = []
    sought = list(kinds)
    while len(found) < MOST:
        best = next(iter(ranked(spectra, sought)), None)
        if best is None or best.chance > level or not best.holds:
            break
        found.append(best)
        # Where the line lies is known to a part of the distance of the last values that were tried.
        around = [best.effect, *(e for name in _searched(best.effect) for e in _around(best.effect, name, ZOOMS))]
        spectra = [each.without(around) for each in spectra]
        sought = [kind for kind in sought if kind is not type(best.effect)]
    return found, spectra


def sidelines(recordings: Sequence[Recording], kinds: Iterable[type[Effect]]) -> list[Sideline]:
    """The best hypothesis of every effect that has a random phase and acts on the signals, the likeliest first."""
    return ranked(between(recordings), kinds)


def ranked(spectra: Sequence[Between], kinds: Iterable[type[Effect]]) -> list[Sideline]:
    """The best hypothesis of every such effect in these spectra, the likeliest first."""
    kinds = [kind for kind in kinds if has_sidelines(kind)] if spectra else []
    found = []
    for kind in kinds:
        declared = quantities(kind)
        size = size_of(kind)
        inner = {name: q.tried for name, q in declared.items() if q.role in (Role.SHAPE, Role.CHOICE)}
        tries = [
            kind(**dict(zip(inner, values, strict=True)), **{size: declared[size].typical})
            for values in product(*inner.values())
        ]
        # The zoom tries some more.
        chances = 2 * len(tries) * len(kinds)
        best = max((_judged(effect, spectra, chances) for effect in tries), key=lambda line: line.rank)
        found.append(_zoomed(best, spectra, chances))
    return sorted(found, key=lambda line: -line.rank)


def has_sidelines(kind: type[Effect]) -> bool:
    """Whether an effect has a random phase, and acts on the recorded signals rather than within the chain."""
    random = any(q.role is Role.RANDOM for q in quantities(kind).values())
    return random and any(getattr(kind, place) is not getattr(Effect, place) for place in ("gauge", "acquisition"))


def _judged(effect: Effect, spectra: Sequence[Between], tried: int) -> Sideline:
    """One hypothesis at all recordings."""
    declared = quantities(type(effect))
    name = size_of(type(effect))
    gain, freedom, size, rest, beside = np.array([each.explained(effect) for each in spectra]).T
    # The floor holds for the whole spectrum; beside the lines it may be somewhat higher or lower.
    noise = (rest.sum() + ALL_TOGETHER) / (beside.sum() + ALL_TOGETHER)
    gain, size = gain / noise, size / noise
    # Power of the effect beyond the noise, in units of its typical size squared.
    share = float(max(gain.sum() - freedom.sum(), 0.0) / max(size.sum(), 1e-300))
    expected = freedom + share * size
    spread = 2 * freedom + 4 * share * size + (2 * TOLERANCE * share * size) ** 2
    used = freedom > 0
    agrees = float(chi2.sf((((gain - expected) ** 2) / np.maximum(spread, 1e-12))[used].sum(), max(used.sum() - 1, 1)))
    numbers = max(freedom.sum(), 1)
    chance = float(min(1.0, tried * f.sf(gain.sum() / numbers, numbers, beside.sum() + ALL_TOGETHER)))
    estimate = float(np.clip(getattr(effect, name) * np.sqrt(share), declared[name].low, declared[name].high))
    deviation = abs(getattr(effect, name)) / float(np.sqrt(max(size.sum(), 1e-300)))
    return Sideline(
        replace(effect, **{name: estimate}), float(gain.sum()), int(freedom.sum()), chance, deviation, agrees
    )


def _zoomed(best: Sideline, spectra: Sequence[Between], tried: int) -> Sideline:
    """The line with its order or frequency no longer on the grid."""
    for name in _searched(best.effect):
        for zoom in range(ZOOMS):
            around = _around(best.effect, name, zoom)
            best = max((_judged(effect, spectra, tried) for effect in around), key=lambda line: line.rank)
    return best


def _searched(effect: Effect) -> list[str]:
    """What is zoomed in on of an effect."""
    return [name for name, q in quantities(type(effect)).items() if q.role is Role.SHAPE and q.points > 1]


def _around(effect: Effect, name: str, zoom: int) -> list[Effect]:
    """The effect at typical size with a parameter moved, half as far with every zoom."""
    q = quantities(type(effect))[name]
    reach = (q.high - q.low) / q.points / 2**zoom
    size = size_of(type(effect))
    typical = quantities(type(effect))[size].typical
    values = np.clip(getattr(effect, name) + reach * np.linspace(-1, 1, 5), q.low, q.high)
    return [replace(effect, **{name: float(value), size: typical}) for value in values]
