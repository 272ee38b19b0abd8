"""Lines between the integer orders: a bearing's cage and balls, the mains, sub-harmonics. Their phase is another one in
every recording, so the model cannot predict them; their power and their pattern over the gauges can be tested.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from jaxtyping import Float
from scipy.stats import chi2

from swgsim.common.chi2_logsf import surprise
from swgsim.effects.base import Effect
from swgsim.effects.quantity import Quantity, Role, quantities, size_of
from swgsim.identification.interharmonics.interharmonic_spectrum import GaugeSpectrum, f_test

# A line's size may differ from its law over load and speed by this share.
TOLERANCE = 0.3
# p-value below which its sizes contradict that law: lower than for other effects, because the best of many places is
# tested.
CONTRADICTION = 1e-4
ZOOMS = 3
# Values of a parameter that are tried at most.
MOST_TRIED = 400


@dataclass(frozen=True)
class Sideline:
    """An effect with random phases, with its estimates from the recordings.

    Attributes
    ----------
    effect : Effect
        At its estimated size; its phases mean nothing.
    gain : float
        Explained sum of squares, in units of the noise next to its lines.
    freedom : int
        Numbers that this fits: a cosine and a sine per recording and independent phase.
    chance : float
        Probability of as much by noise anywhere in the library.
    deviation : float
        Standard deviation of the size.
    agrees : float
        Probability that recordings differ so much from the effect's law, if that is right to TOLERANCE.
    explained : float
        Explained sum of squares above the noise next to its lines, in units of the noise floor.
    """

    effect: Effect
    gain: float
    freedom: int
    chance: float
    deviation: float
    agrees: float
    explained: float

    @property
    def rank(self) -> float:
        """Significance of the gain, for sorting."""
        return surprise(self.gain, self.freedom)

    @property
    def holds(self) -> bool:
        """Whether all recordings follow the effect's law."""
        return self.agrees > CONTRADICTION


def ranked(spectra: Sequence[GaugeSpectrum], kinds: Iterable[type[Effect]]) -> list[Sideline]:
    """The best hypothesis of every effect with a random phase that acts on the signals, the likeliest first."""
    kinds = [kind for kind in kinds if has_sidelines(kind)] if spectra else []
    found = []
    for kind in kinds:
        declared = quantities(kind)
        size = size_of(kind)
        inner = {name: _tried(q, spectra) for name, q in declared.items() if q.role in (Role.SHAPE, Role.CHOICE)}
        tries = [
            kind(**dict(zip(inner, values, strict=True)), **{size: declared[size].typical})
            for values in product(*inner.values())
        ]
        # The zoom tries some more.
        chances = 2 * len(tries) * len(kinds)
        best = _best(tries, spectra, chances)
        found.append(_zoomed(best, spectra, chances))
    return sorted(found, key=lambda line: (line.chance, -line.rank))


def nearby(effect: Effect, spectra: Sequence[GaugeSpectrum]) -> list[Effect]:
    """An effect and its neighbours: where its line lies is known to a part of the last zoom, which begins at the
    distance of two lines or at that of the values that were tried.
    """
    found = [effect]
    for name in _searched(effect):
        quantity = quantities(type(effect))[name]
        for spacing in sorted({_apart(quantity, spectra), _spacing(quantity, spectra)}):
            found += _around(effect, name, spacing / 2**ZOOMS)
    return found


def has_sidelines(kind: type[Effect]) -> bool:
    """Whether an effect has a random phase, and acts on the recorded signals rather than within the chain."""
    return is_random(kind) and acts_on_signals(kind)


def is_random(kind: type[Effect]) -> bool:
    """Whether an effect has another phase in every recording."""
    return any(q.role is Role.RANDOM for q in quantities(kind).values())


def acts_on_signals(kind: type[Effect]) -> bool:
    """Whether an effect acts on the recorded signals."""
    return any(getattr(kind, place) is not getattr(Effect, place) for place in ("gauge", "acquisition"))


def _best(effects: Sequence[Effect], spectra: Sequence[GaugeSpectrum], tried: int) -> Sideline:
    """The likeliest of some hypotheses of one kind at all recordings."""
    explained = np.array([each.explained(effects) for each in spectra])
    lines = (_judged(effect, explained[..., i], tried) for i, effect in enumerate(effects))
    return max(lines, key=lambda line: line.rank)


def _judged(effect: Effect, sums: Float[np.ndarray, "recording number"], tried: int) -> Sideline:
    """One hypothesis, by what it explains of all recordings."""
    declared = quantities(type(effect))
    name = size_of(type(effect))
    gain, freedom, size, rest, count = sums.T
    numbers = max(freedom.sum(), 1.0)
    noise, p_value = f_test(gain.sum(), numbers, rest.sum(), count.sum())
    explained = float(gain.sum() - noise * freedom.sum())
    gain, size = gain / noise, size / noise
    share, expected, variance = by_law(gain, freedom, size)
    used = freedom > 0
    squares = (gain - expected)[used] ** 2 / variance[used]
    agrees = float(chi2.sf(squares.sum(), max(used.sum() - 1, 1)))
    chance = float(min(1.0, tried * p_value))
    estimate = float(np.clip(getattr(effect, name) * np.sqrt(share), declared[name].low, declared[name].high))
    deviation = float(abs(getattr(effect, name)) / np.sqrt(max(size.sum(), 1e-300)))
    # The law may be off in every recording, and then so is the mean.
    deviation = float(np.hypot(deviation, TOLERANCE * estimate / np.sqrt(max(used.sum(), 1))))
    return Sideline(
        replace(effect, **{name: estimate}), float(gain.sum()), int(freedom.sum()), chance, deviation, agrees, explained
    )


def by_law(
    gain: Float[np.ndarray, " recording"],
    freedom: Float[np.ndarray, " recording"],
    size: Float[np.ndarray, " recording"],
) -> tuple[float, Float[np.ndarray, " recording"], Float[np.ndarray, " recording"]]:
    """What an effect's law, good to TOLERANCE, makes of its gains.

    The power of the effect beyond the noise, in units of its own size squared, so that the law as a whole fits; and
    what is expected of every recording's gain then: mean and variance.

    Parameters
    ----------
    gain, freedom : array (recording,)
        Sum of squares that it explains, in units of the noise, and its degrees of freedom.
    size : array (recording,)
        Gain that it would have without noise at the size that it is given with.
    """
    share = float(max(gain.sum() - freedom.sum(), 0.0) / max(size.sum(), 1e-300))
    brought = share * size
    return share, freedom + brought, 2 * freedom + 4 * brought + (2 * TOLERANCE * brought) ** 2


def _zoomed(best: Sideline, spectra: Sequence[GaugeSpectrum], tried: int) -> Sideline:
    """The line with its order or frequency no longer on the grid."""
    for name in _searched(best.effect):
        reach = _spacing(quantities(type(best.effect))[name], spectra)
        for zoom in range(ZOOMS):
            around = _around(best.effect, name, reach / 2**zoom)
            best = _best(around, spectra, tried)
    return best


def _searched(effect: Effect) -> list[str]:
    """What is zoomed in on of an effect."""
    return [name for name, q in quantities(type(effect)).items() if q.role is Role.SHAPE and q.points > 1]


def _tried(quantity: Quantity, spectra: Sequence[GaugeSpectrum]) -> tuple[float, ...]:
    """Values of a parameter that are tried: those declared, closer together where the lines of the spectra are."""
    if quantity.role is not Role.SHAPE or quantity.points == 1:
        return quantity.tried
    count = int(np.ceil((quantity.high - quantity.low) / _spacing(quantity, spectra))) + 1
    return tuple(np.linspace(quantity.low, quantity.high, count).tolist())


def _spacing(quantity: Quantity, spectra: Sequence[GaugeSpectrum]) -> float:
    """Distance of the values that are tried: that of two lines, or as many as can be."""
    return max(_apart(quantity, spectra), (quantity.high - quantity.low) / MOST_TRIED)


def _apart(quantity: Quantity, spectra: Sequence[GaugeSpectrum]) -> float:
    """Distance that is declared, and no more than that of two lines of the finest spectrum."""
    declared = (quantity.high - quantity.low) / (quantity.points - 1)
    return min(declared, min(each.step if quantity.unit == "Hz" else 1 / each.revolutions for each in spectra))


def _around(effect: Effect, name: str, reach: float) -> list[Effect]:
    """The effect at typical size with a parameter moved."""
    q, size = quantities(type(effect))[name], size_of(type(effect))
    typical = quantities(type(effect))[size].typical
    values = np.clip(getattr(effect, name) + reach * np.linspace(-1, 1, 5), q.low, q.high)
    return [replace(effect, **{name: float(value), size: typical}) for value in values]
