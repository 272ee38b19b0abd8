"""Lines between the integer orders that no effect of the library explains: at one order, or at one frequency."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.stats import f

from swgsim.loop.between import BESIDE, Between
from swgsim.loop.features import FITTED
from swgsim.loop.sidelines import ALL_TOGETHER

KINDS = ("order", "frequency")
# Lines to either side that may hold a part of a line between them.
SPILLED = 1


@dataclass(frozen=True)
class Unnamed:
    """A line that stands out of the noise.

    Attributes
    ----------
    kind : str
        Of :data:`KINDS`: an order of the wave generator, or a frequency.
    at : float
        Where it lies [-] or [Hz].
    amplitude : float
        Root mean square over the recordings of its amplitude in the gauge where it is largest [mV/V].
    gauge : str
        That gauge.
    chance : float
        Of as much by noise anywhere.
    """

    kind: str
    at: float
    amplitude: float
    gauge: str
    chance: float

    def __str__(self) -> str:
        where = f"order {self.at:.2f}" if self.kind == "order" else f"{self.at:.1f} Hz"
        return (
            f"a line at {where} with another phase in every recording, amplitude {self.amplitude:.3g} mV/V in "
            f"{self.gauge}, where it is largest"
        )


def unnamed(spectra: Sequence[Between], level: float) -> Unnamed | None:
    """The line that is most unlikely to be luck, if any is.

    Parameters
    ----------
    spectra : sequence of Between
        Without what is explained.
    level : float
        Probability of a false one.
    """
    found = [line for kind in KINDS for line in _best(spectra, kind)] if spectra else []
    best = min(found, key=lambda line: line.chance, default=None)
    return best if best and best.chance <= level else None


def _best(spectra: Sequence[Between], kind: str) -> list[Unnamed]:
    """The best line at one order, or at one frequency; none if no place has a clear line in most recordings."""
    steps = [each.step if kind == "frequency" else 1 / each.revolutions for each in spectra]
    end = FITTED * max(1.0 if kind == "order" else each.revolutions * each.step for each in spectra)
    grid = np.arange(min(steps), end, min(steps) / 2)
    gain, freedom, rest, beside, seen = np.zeros((5, len(grid)))
    for each, step in zip(spectra, steps, strict=True):
        line = np.round(grid / step).astype(int) - 1
        there = (line >= 0) & (line < len(each.clear))
        there[there] = each.clear[line[there]]
        power, numbers = each.power.sum(axis=0) * each.clear, 2.0 * len(each.gauges) * each.clear
        gain[there] += power[line[there]]
        freedom[there] += numbers[line[there]]
        rest[there] += _beside(power)[line[there]]
        beside[there] += _beside(numbers)[line[there]]
        seen += there
    tried = np.flatnonzero(seen > len(spectra) / 2)
    if not len(tried):
        return []
    gain, freedom, rest, beside = (each[tried] for each in (gain, freedom, rest, beside))
    noise = (rest + ALL_TOGETHER) / (beside + ALL_TOGETHER)
    chances = f.sf(gain / noise / freedom, freedom, beside + ALL_TOGETHER)
    best = tried[int(np.argmin(chances))]
    amplitude = _amplitudes(spectra, [round(grid[best] / step) - 1 for step in steps])
    largest = int(np.argmax(amplitude))
    chance = float(min(1.0, chances.min() * len(tried) * len(KINDS)))
    return [Unnamed(kind, float(grid[best]), float(amplitude[largest]), spectra[0].gauges[largest], chance)]


def _beside(lines: Float[np.ndarray, " line"]) -> Float[np.ndarray, " line"]:
    """Sum over the lines to both sides of each, without those that may hold a part of it."""
    window = np.ones(2 * BESIDE + 1)
    window[BESIDE - SPILLED : BESIDE + SPILLED + 1] = 0
    return np.convolve(np.pad(lines, BESIDE), window, "valid")


def _amplitudes(spectra: Sequence[Between], lines: Sequence[int]) -> Float[np.ndarray, " gauge"]:
    """Amplitude of a line in every gauge [mV/V], root mean square over the recordings that show it."""
    squares = [
        4 * np.maximum(each.power[:, line] - 2, 0) / each.scale[:, line] ** 2
        for each, line in zip(spectra, lines, strict=True)
        if 0 <= line < len(each.clear) and each.clear[line]
    ]
    return np.sqrt(np.mean(squares, axis=0))
