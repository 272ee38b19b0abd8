"""Interharmonic lines without a known cause, at a constant order or at a constant frequency."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from jaxtyping import Float

from swgsim.effects.line_between import FixedFrequency, FractionalOrder, LineBetween
from swgsim.identification.data.features import FITTED
from swgsim.identification.interharmonics.interharmonic_spectrum import NOISE_LINES, GaugeSpectrum, f_test
from swgsim.identification.interharmonics.line_pattern import Part, line_parts

KINDS = ("order", "frequency")
# Times that the distance of the places that are tried is halved.
ZOOMS = 3
# Lines to either side that may hold a part of a line between them.
SPILLED = 1


@dataclass(frozen=True)
class Unnamed:
    """A significant interharmonic line.

    Attributes
    ----------
    kind : str
        Of :data:`KINDS`: an order of the wave generator, or a frequency.
    at : float
        Where it lies [-] or [Hz].
    chance : float
        p-value in a search of all places.
    explained : float
        Explained sum of squares above the noise next to it, in units of the noise floor.
    reach : float
        Uncertainty of its place.
    noise : float
        Sum of squares of the noise next to it, in units of the noise floor.
    parts : tuple of Part
        Its pattern over the gauges and its law; several if no pattern explains it.
    """

    kind: str
    at: float
    chance: float
    explained: float
    reach: float
    noise: float
    parts: tuple[Part, ...] = ()

    @property
    def effects(self) -> list[LineBetween]:
        """Possible lines in every gauge within the uncertainty of its place."""
        places = self.at + self.reach * np.array([-1.0, 0.0, 1.0])
        return [_line(self.kind, place) for place in places.tolist()]

    def alone(self, gauges: Sequence[str]) -> list[LineBetween]:
        """The line in each of these gauges."""
        return [_line(self.kind, self.at, f"in {gauge} alone") for gauge in gauges]

    def with_parts(self, spectra: Sequence[GaugeSpectrum], level: float) -> "Unnamed":
        """The line with its parts; a gauge is a false one with this probability."""
        make = partial(_line, self.kind, self.at)
        return replace(self, parts=line_parts(make, spectra, level))

    def refined(self, spectra: Sequence[GaugeSpectrum]) -> "Unnamed":
        """The line where it explains most, no longer at a place of the grid, between two of which it loses half."""
        tried: dict[float, float] = {}  # by steps from here: places of one zoom are also those of the next one
        best = 0.0
        for zoom in range(ZOOMS):
            near = [best + step / 2**zoom for step in (-1.0, -0.5, 0.0, 0.5, 1.0)]
            tried |= {steps: self._held(steps, spectra) for steps in near if steps not in tried}
            best = max(near, key=lambda steps: tried[steps])
        return replace(
            self, at=float(self.at + best * self.reach), explained=tried[best] - self.noise, reach=self.reach / 2**ZOOMS
        )

    def _held(self, steps: float, spectra: Sequence[GaugeSpectrum]) -> float:
        line = _line(self.kind, self.at + steps * self.reach)
        return float(sum(each.held([line], apart=each.gauges) for each in spectra))

    def __str__(self) -> str:
        where = f"order {self.at:.2f}" if self.kind == "order" else f"{self.at:.1f} Hz"
        return f"a line at {where} with another phase in every recording{self._of_parts}"

    @property
    def _of_parts(self) -> str:
        if len(self.parts) < 2:
            return "".join(f", {part}" for part in self.parts)
        first, *others = (f"{part}".replace(" alone", "", 1) for part in self.parts)
        further = " and ".join(each.partition(",")[0] for each in others)
        return f", {first}; smaller, and in no simple pattern with it, {further}"


def _line(kind: str, place: float, pattern: str = LineBetween.pattern) -> LineBetween:
    """A line of a size far above rounding."""
    if kind == "order":
        return FractionalOrder(1.0, pattern=pattern, order=place)
    return FixedFrequency(1.0, pattern=pattern, frequency=place)


def unnamed(spectra: Sequence[GaugeSpectrum], level: float) -> Unnamed | None:
    """The significant line with the largest explained sum of squares, without its parts, or None.

    Parameters
    ----------
    spectra : sequence of GaugeSpectrum
        Without what is explained.
    level : float
        Probability of a false one.
    """
    found = [line for kind in KINDS for line in _best(spectra, kind, level)] if spectra else []
    best = max(found, key=lambda line: line.explained, default=None)
    return best.refined(spectra) if best else None


def _best(spectra: Sequence[GaugeSpectrum], kind: str, level: float) -> list[Unnamed]:
    """The best line at one order, or at one frequency; none if all may be luck, or no place is clear in most.

    The noise beside a line holds what leaks from it, so it tells that a strong line is none, and not which is stronger.
    """
    steps = [each.step if kind == "frequency" else 1 / each.revolutions for each in spectra]
    end = FITTED * max(1.0 if kind == "order" else each.revolutions * each.step for each in spectra)
    grid = np.arange(min(steps), end, min(steps) / 2)
    gain, freedom, rest, count, seen = np.zeros((5, len(grid)))
    for each, step in zip(spectra, steps, strict=True):
        line = np.round(grid / step).astype(int) - 1
        there = (line >= 0) & (line < len(each.clear))
        there[there] = each.clear[line[there]]
        power, numbers = each.power.sum(axis=0), 2.0 * len(each.gauges) * each.clear
        gain[there] += power[line[there]]
        freedom[there] += numbers[line[there]]
        rest[there] += _neighbours(power)[line[there]]
        count[there] += _neighbours(numbers)[line[there]]
        seen += there
    tried = np.flatnonzero(seen > len(spectra) / 2)
    if not len(tried):
        return []
    gain, freedom, rest, count = (each[tried] for each in (gain, freedom, rest, count))
    noise, p_value = f_test(gain, freedom, rest, count)
    chances = np.minimum(1.0, len(tried) * len(KINDS) * p_value)
    by_noise = noise * freedom
    explained = np.where(chances <= level, gain - by_noise, -np.inf)
    most = int(np.argmax(explained))
    if chances[most] > level:
        return []
    known = float(chances[most]), float(explained[most]), min(steps) / 2, float(by_noise[most])
    return [Unnamed(kind, float(grid[tried[most]]), *known)]


def _neighbours(lines: Float[np.ndarray, " line"]) -> Float[np.ndarray, " line"]:
    """Sum over the lines to both sides of each, without those that may hold a part of it."""
    window = np.ones(2 * NOISE_LINES + 1)
    window[NOISE_LINES - SPILLED : NOISE_LINES + SPILLED + 1] = 0
    return np.convolve(np.pad(lines, NOISE_LINES), window, "valid")
