"""Lines between the integer orders that no effect of the library explains: at one order, or at one frequency."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import random_phase, size
from swgsim.loop.between import BESIDE, Between, by_luck
from swgsim.loop.features import FITTED
from swgsim.recordings import SENSORS

KINDS = ("order", "frequency")
# Times that the distance of the places that are tried is halved.
ZOOMS = 3
# Lines to either side that may hold a part of a line between them.
SPILLED = 1


@dataclass(frozen=True)
class Line(Effect):
    """A line in one gauge, with another phase in every recording.

    Attributes
    ----------
    sensor : str
    kind : str
        Of :data:`KINDS`.
    where : float
        Order [-] or frequency [Hz].
    amplitude : float
        [mV/V]
    phase : float
        [rad]
    """

    sensor: str
    kind: str
    where: float
    amplitude: float = size(unit="mV/V", low=0, high=1, typical=1.0)
    phase: float = random_phase()

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals with the line on one of them."""
        angle = self.where * (scene.phi_in if self.kind == "order" else 2 * np.pi * scene.time)
        mine = np.array([sensor == self.sensor for sensor in SENSORS])
        return signals + mine[:, None] * self.amplitude * np.cos(angle + self.phase)


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
    explained : float
        Sum of squares that it explains beyond the noise beside it, in units of the floor.
    reach : float
        To which its place is known.
    noise : float
        Sum of squares that the noise beside it makes of its numbers, in units of the floor.
    """

    kind: str
    at: float
    amplitude: float
    gauge: str
    chance: float
    explained: float
    reach: float
    noise: float

    def effects(self, gauges: Sequence[str]) -> list[Effect]:
        """Whatever it may be in these gauges, its place being known to its reach."""
        places = self.at + self.reach * np.array([-1.0, 0.0, 1.0])
        return [Line(gauge, self.kind, float(place), 1.0) for gauge in gauges for place in places]

    def refined(self, spectra: Sequence[Between]) -> "Unnamed":
        """The line where it explains most, no longer at a place of the grid, between two of which it loses half."""
        found = self
        for _ in range(ZOOMS):
            near = [found._at(float(found.at + found.reach * step), spectra) for step in (-1.0, -0.5, 0.0, 0.5, 1.0)]
            found = replace(max(near, key=lambda line: line.explained), reach=found.reach / 2)
        return found

    def _at(self, place: float, spectra: Sequence[Between]) -> "Unnamed":
        held = sum(each.held([Line(gauge, self.kind, place, 1.0) for gauge in each.gauges]) for each in spectra)
        return replace(self, at=place, explained=float(held - self.noise))

    def __str__(self) -> str:
        where = f"order {self.at:.2f}" if self.kind == "order" else f"{self.at:.1f} Hz"
        return (
            f"a line at {where} with another phase in every recording, amplitude {self.amplitude:.3g} mV/V in "
            f"{self.gauge}, where it is largest"
        )


def unnamed(spectra: Sequence[Between], level: float) -> Unnamed | None:
    """Of the lines that are too unlikely to be luck, the one that explains most, if there is any.

    Parameters
    ----------
    spectra : sequence of Between
        Without what is explained.
    level : float
        Probability of a false one.
    """
    found = [line for kind in KINDS for line in _best(spectra, kind, level)] if spectra else []
    best = max(found, key=lambda line: line.explained, default=None)
    return best.refined(spectra) if best else None


def _best(spectra: Sequence[Between], kind: str, level: float) -> list[Unnamed]:
    """The best line at one order, or at one frequency; none if all may be luck, or no place is clear in most.

    The noise beside a line holds what leaks from it, so it tells that a strong line is none, and not which is stronger.
    """
    steps = [each.step if kind == "frequency" else 1 / each.revolutions for each in spectra]
    end = FITTED * max(1.0 if kind == "order" else each.revolutions * each.step for each in spectra)
    grid = np.arange(min(steps), end, min(steps) / 2)
    gain, freedom, rest, beside, seen = np.zeros((5, len(grid)))
    for each, step in zip(spectra, steps, strict=True):
        line = np.round(grid / step).astype(int) - 1
        there = (line >= 0) & (line < len(each.clear))
        there[there] = each.clear[line[there]]
        power, numbers = each.power.sum(axis=0), 2.0 * len(each.gauges) * each.clear
        gain[there] += power[line[there]]
        freedom[there] += numbers[line[there]]
        rest[there] += _beside(power)[line[there]]
        beside[there] += _beside(numbers)[line[there]]
        seen += there
    tried = np.flatnonzero(seen > len(spectra) / 2)
    if not len(tried):
        return []
    gain, freedom, rest, beside = (each[tried] for each in (gain, freedom, rest, beside))
    noise, luck = by_luck(gain, freedom, rest, beside)
    chances = np.minimum(1.0, len(tried) * len(KINDS) * luck)
    by_noise = noise * freedom
    explained = np.where(chances <= level, gain - by_noise, -np.inf)
    most = int(np.argmax(explained))
    if chances[most] > level:
        return []
    best = tried[most]
    amplitude = _amplitudes(spectra, [round(grid[best] / step) - 1 for step in steps])
    largest = int(np.argmax(amplitude))
    return [
        Unnamed(
            kind, float(grid[best]), float(amplitude[largest]), spectra[0].gauges[largest], float(chances[most]),
            float(explained[most]), min(steps) / 2, float(by_noise[most]),
        )
    ]  # fmt: skip


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
