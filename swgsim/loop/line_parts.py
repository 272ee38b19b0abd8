"""Pattern over the gauges and law of a line between the orders that has no name."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from swgsim.effects.line_between import GAUGE_PATTERNS, LineBetween
from swgsim.effects.quantity import quantities
from swgsim.effects.regularity import LAWS
from swgsim.loop.between import Between, by_luck
from swgsim.loop.evidence import LEAST_GAIN, OUTDONE, OUTDONE_SHARE
from swgsim.loop.sidelines import by_law


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


def line_parts(
    line: Callable[[str], LineBetween], explained: float, spectra: Sequence[Between], level: float
) -> tuple[Part, ...]:
    """The line in the pattern that explains it; if none does, in every gauge that shows it, the strongest first.

    Parameters
    ----------
    line : callable
        Pattern to the line in it.
    explained : float
        Sum of squares that it explains in all gauges, of any size and phase in each.
    spectra : sequence of Between
        Which show it.
    level : float
        Probability of a false gauge.
    """
    gauges = set(spectra[0].gauges)
    shown = [_Shown.of(line(name), spectra) for name, pattern in GAUGE_PATTERNS.items() if set(pattern) <= gauges]
    best = max(shown, key=lambda each: each.explained)
    if explained <= (1 + OUTDONE_SHARE) * best.explained + OUTDONE:
        return (best.part(spectra),)
    alone = [each for each in shown if len(GAUGE_PATTERNS[each.line.pattern]) == 1 and each.chance <= level]
    return tuple(each.part(spectra) for each in sorted(alone or [best], key=lambda each: -each.explained))


@dataclass(frozen=True, eq=False)
class _Shown:
    """What recordings show of a line in one pattern: ``gain`` and ``freedom`` as in
    :class:`swgsim.loop.between.Explained`, the gain that its size would bring by a law of 1, and the chance of as much.
    """

    line: LineBetween
    gain: Float[np.ndarray, " recording"]
    freedom: Float[np.ndarray, " recording"]
    size: Float[np.ndarray, " recording"]
    explained: float
    chance: float

    @classmethod
    def of(cls, line: LineBetween, spectra: Sequence[Between]) -> "_Shown":
        """Of a line whose law is constant."""
        gain, freedom, size, rest, beside = np.array([each.explained(line) for each in spectra]).T
        noise, chance = by_luck(gain.sum(), max(freedom.sum(), 1.0), rest.sum(), beside.sum())
        return cls(line, gain / noise, freedom, size / noise, float(gain.sum() - noise * freedom.sum()), float(chance))

    def part(self, spectra: Sequence[Between]) -> Part:
        """The line by the simplest of the laws that explain it best."""
        likely = {name: each for name in LAWS if (each := self._by(name, spectra))}
        best = max(log_likelihood for log_likelihood, _ in likely.values())
        law, *rivals = [name for name, (log_likelihood, _) in likely.items() if best - log_likelihood < LEAST_GAIN]
        highest = quantities(type(self.line))["amplitude"].high
        amplitude = min(self.line.amplitude * likely[law][1], highest)
        return Part(replace(self.line, law=law, amplitude=float(amplitude)), tuple(rivals))

    def _by(self, law: str, spectra: Sequence[Between]) -> tuple[float, float] | None:
        """Log-likelihood of a law and factor on the size by it; None for one that has no line in any recording."""
        factors = np.array([LAWS[law](each.scene.point, each.scene.conditions) for each in spectra])
        size = self.size * factors**2
        if not size.any():
            return None
        share, expected, variance = by_law(self.gain, self.freedom, size)
        used = self.freedom > 0
        squares = (self.gain - expected)[used] ** 2 / variance[used]
        return -0.5 * float((squares + np.log(variance[used])).sum()), float(np.sqrt(share))
