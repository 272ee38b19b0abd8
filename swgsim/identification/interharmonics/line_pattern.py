"""Pattern over the gauges and law of a line between the orders that has no name."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from swgsim.effects.line_between import GAUGE_PATTERNS, LineBetween
from swgsim.effects.quantity import quantities
from swgsim.effects.regularity import LAWS
from swgsim.identification.fit.form_error import LEAST_GAIN
from swgsim.identification.interharmonics.interharmonic_spectrum import Explained, GaugeSpectrum, f_test
from swgsim.identification.interharmonics.named_interharmonics import by_law

# A description with more numbers replaces another one only if it explains more. The excess must be above the first
# number, a sum of squares, plus the second number times what the other one explains (estimates).
OUTDONE, OUTDONE_SHARE = 17.0, 0.05


@dataclass(frozen=True)
class Part:
    """A line in one pattern.

    Attributes
    ----------
    effect : LineBetween
        By the simplest law that explains it, at its estimated size; its phase means nothing.
    rivals : tuple of str
        Other laws that explain it as well.
    """

    effect: LineBetween
    rivals: tuple[str, ...]

    def __str__(self) -> str:
        law = self.effect.law + (f" (or {', or '.join(self.rivals)})" if self.rivals else "")
        return f"{self.effect.pattern}, {law}, amplitude {self.effect.amplitude:.3g} mV/V"


def line_parts(line: Callable[[str], LineBetween], spectra: Sequence[GaugeSpectrum], level: float) -> tuple[Part, ...]:
    """The line in the pattern that explains most of it, and in every further gauge that shows it; in every gauge by
    itself if that explains clearly more than the pattern does. The strongest comes first.

    Parameters
    ----------
    line : callable
        Pattern to the line in it.
    spectra : sequence of GaugeSpectrum
        Which show it.
    level : float
        Probability of a false gauge.
    """
    gauges = spectra[0].gauges
    patterns = _Shown.of([line(name) for name in distinct_patterns(gauges)], spectra, GaugeSpectrum.explained)
    best = max(patterns, key=lambda each: each.explained)
    # The lines of the other gauges are no noise.
    in_gauges = [line(f"in {gauge} alone") for gauge in gauges]
    alone = dict(zip(gauges, _Shown.of(in_gauges, spectra, GaugeSpectrum.explained_beside), strict=True))
    within = [gauge for gauge in gauges if gauge in GAUGE_PATTERNS[best.line.pattern]]
    together = not outdoes(sum(alone[gauge].explained for gauge in within), best.explained)
    further = [each for gauge, each in alone.items() if each.chance <= level and not (together and gauge in within)]
    found = [best, *further] if together or not further else further
    return tuple(each.part() for each in sorted(found, key=lambda each: -each.explained))


def outdoes(more: float, explained: float) -> bool:
    """Whether a description with more numbers explains clearly more than another one, as sums of squares."""
    return more > (1 + OUTDONE_SHARE) * explained + OUTDONE


def distinct_patterns(gauges: Sequence[str]) -> list[str]:
    """The patterns that these gauges can distinguish, first those with all gauges recorded."""
    found: dict[tuple, str] = {}
    for name, pattern in sorted(GAUGE_PATTERNS.items(), key=lambda each: not set(each[1]) <= set(gauges)):
        weights = [pattern.get(gauge, 0) for gauge in gauges]
        turn = next((weight for weight in weights if weight), None)
        if turn is not None:
            found.setdefault(tuple(weight / turn for weight in weights), name)
    return list(found.values())


@dataclass(frozen=True, eq=False)
class _Shown:
    """What recordings show of a line in one pattern: ``gain`` and ``freedom`` as in
    :class:`Explained`, the gain that its size would bring by a law of 1, and the chance of as much.
    """

    line: LineBetween
    spectra: Sequence[GaugeSpectrum]
    gain: Float[np.ndarray, " recording"]
    freedom: Float[np.ndarray, " recording"]
    size: Float[np.ndarray, " recording"]
    explained: float
    chance: float

    @classmethod
    def of(
        cls,
        lines: Sequence[LineBetween],
        spectra: Sequence[GaugeSpectrum],
        explained_by: Callable[[GaugeSpectrum, Sequence[LineBetween]], Explained],
    ) -> "list[_Shown]":
        """Of each of some lines whose law is constant."""
        found = []
        every = np.array([explained_by(each, lines) for each in spectra]).transpose(2, 1, 0)
        for line, (gain, freedom, size, rest, count) in zip(lines, every, strict=True):
            noise, chance = f_test(gain.sum(), max(freedom.sum(), 1.0), rest.sum(), count.sum())
            explained = float(gain.sum() - noise * freedom.sum())
            found.append(cls(line, spectra, gain / noise, freedom, size / noise, explained, float(chance)))
        return found

    def part(self) -> Part:
        """The line by the simplest of the laws that explain it best."""
        likely = {name: self._by(name) for name in LAWS}
        best = max(log_likelihood for log_likelihood, _ in likely.values())
        law, *rivals = [name for name, (log_likelihood, _) in likely.items() if best - log_likelihood < LEAST_GAIN]
        return Part(replace(self.line, law=law, amplitude=likely[law][1]), tuple(rivals))

    def _by(self, law: str) -> tuple[float, float]:
        """Log-likelihood of a law, and the amplitude by it; where that would lie beyond its bounds, only a constant is
        left.
        """
        factors = np.array([LAWS[law](each.scene.point, each.scene.conditions) for each in self.spectra])
        share, expected, variance = by_law(self.gain, self.freedom, self.size * factors**2)
        amplitude, highest = self.line.amplitude * float(np.sqrt(share)), quantities(type(self.line))["amplitude"].high
        if law != "constant" and (amplitude > highest or not factors.any()):
            return -np.inf, 0.0
        used = self.freedom > 0
        squares = (self.gain - expected)[used] ** 2 / variance[used]
        return -0.5 * float((squares + np.log(variance[used])).sum()), min(amplitude, highest)
