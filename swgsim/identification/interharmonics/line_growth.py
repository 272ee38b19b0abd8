"""Test whether an interharmonic line is larger than in the healthy gear.

Its phase is another one in every recording, so powers are compared. At the same operating point they differ by noise,
by the scatter of the amplitude from recording to recording, which repeats tell, and by its spread from day to day.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.stats import norm, t

from swgsim.effects.base import Effect
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.interharmonics.interharmonic_spectrum import GaugeSpectrum, f_test

# Standard deviation of the logarithm of an amplitude from day to day (an estimate). The mains may differ by 10 %
# (EN 50160); where cables lie, and how a gear is mounted and preloaded, matters more.
DAY_TO_DAY_SD = 0.2
# From recording to recording where nothing was repeated: no less than from day to day.
UNREPEATED_SD = DAY_TO_DAY_SD
# Standard normal deviates over which the days are integrated.
DEVIATES = np.linspace(-6.0, 6.0, 241)


def chance_of_growth(
    parts: Sequence[Effect], spectra: Sequence[GaugeSpectrum], healthy: Sequence[GaugeSpectrum]
) -> float:
    """Probability that a line of the healthy gear shows as much of any of these parts, each of a size of its own.

    It is 0 if the healthy recordings cannot show the line.
    """
    now, before = (np.array([each.explained_beside(parts) for each in some]) for some in (spectra, healthy))
    points = [[each.scene.point for each in some] for some in (spectra, healthy)]
    chances = [
        _chance(_Powers.of(points[0], now[..., i]), _Powers.of(points[1], before[..., i])) for i in range(len(parts))
    ]
    return min(1.0, len(parts) * min(chances))


@dataclass(frozen=True, eq=False)
class _Powers:
    """Power of a line in recordings, as a share of what its effect has at the size that it is given with, less noise.

    Attributes
    ----------
    points : tuple of OperatingPoint
    power : array (recording,)
    freedom : array (recording,)
        Numbers that were fitted, each with a noise of variance 1.
    size : array (recording,)
        Sum of squares that a power of 1 brings, in units of the noise.
    """

    points: tuple[OperatingPoint, ...]
    power: Float[np.ndarray, " recording"]
    freedom: Float[np.ndarray, " recording"]
    size: Float[np.ndarray, " recording"]

    @classmethod
    def of(cls, points: Sequence[OperatingPoint], sums: Float[np.ndarray, "recording number"]) -> "_Powers":
        """By what the line explains of recordings (:class:`Explained`): at some speeds a frequency lies on an order."""
        gain, freedom, size, rest, count = sums.T
        noise, _ = f_test(gain.sum(), max(freedom.sum(), 1.0), rest.sum(), count.sum())
        shown = (freedom > 0) & (size > 0)
        seen = tuple(each for each, there in zip(points, shown, strict=True) if there)
        gain, freedom, size = gain[shown] / noise, freedom[shown], size[shown] / noise
        return cls(seen, (gain - freedom) / size, freedom, size)

    def at(self, point: OperatingPoint) -> "_Powers":
        """Those at one operating point."""
        own = np.array([each == point for each in self.points], bool)
        return _Powers((point,) * int(own.sum()), self.power[own], self.freedom[own], self.size[own])

    def noise(self, power: float) -> Float[np.ndarray, " recording"]:
        """Variance of each by noise, where the line has this power: of a noncentral chi-squared number."""
        return (2 * self.freedom + 4 * power * self.size) / self.size**2


def _chance(now: _Powers, before: _Powers) -> float:
    """The same of one part: a t-test of the sum of the powers over the operating points, averaged over the days."""
    if not now.points or not before.points:
        return 0.0
    # Where no operating point is the same, the law of the effect has to do.
    common = [point for point in dict.fromkeys(now.points) if point in before.points]
    groups = [(now.at(point), before.at(point)) for point in common] or [(now, before)]
    means = [max(float(np.mean(np.concatenate([a.power, b.power]))), 0.0) for a, b in groups]
    spread, freedom = _scatter([of_healthy for _, of_healthy in groups])
    variance = sum(
        float(((spread * mean) ** 2 + each.noise(mean)).sum()) / len(each.points) ** 2
        for group, mean in zip(groups, means, strict=True)
        for each in group
    )
    shown, known = (float(sum(group[i].power.mean() for group in groups)) for i in (0, 1))
    # Two days differ, of each of which the amplitude has its own factor.
    days = max(known, 0.0) * np.exp(2 * np.sqrt(2) * DAY_TO_DAY_SD * DEVIATES)
    weight = norm.pdf(DEVIATES)
    return float(t.sf((shown - days) / np.sqrt(variance), freedom) @ weight / weight.sum())


def _scatter(healthy: Sequence[_Powers]) -> tuple[float, float]:
    """Standard deviation of a power from recording to recording as a share of it, and its degrees of freedom."""
    squares = noise = brought = 0.0
    repeats = 0
    for each in healthy:
        count, mean = len(each.points), max(float(each.power.mean()), 0.0)
        squares += float(((each.power - each.power.mean()) ** 2).sum())
        noise += (1 - 1 / count) * float(each.noise(mean).sum())
        brought += (count - 1) * mean**2
        repeats += count - 1
    if not repeats:
        return 2 * UNREPEATED_SD, np.inf
    # No line scatters more than noise of a narrow band, whose power is exponentially distributed. A healthy gear that
    # hardly shows the line says no more than that.
    return float(np.sqrt(min(max(squares - noise, 0.0) / brought, 1.0))) if brought else 0.0, float(repeats)
