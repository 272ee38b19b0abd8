"""Lines between the integer orders that no effect of the library explains: at one order, or at one frequency."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.stats import f

from swgsim.loop.between import BESIDE, Between
from swgsim.loop.features import FITTED
from swgsim.loop.sidelines import ALL_TOGETHER


@dataclass(frozen=True)
class Unnamed:
    """A line that stands out of the noise.

    Attributes
    ----------
    kind : str
        "order" of the wave generator, or "frequency".
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
    if not spectra:
        return None
    fastest = max(each.scene.point.n_in_rpm for each in spectra) / 60
    grids = {
        "order": [each.step * 60 / each.scene.point.n_in_rpm for each in spectra],
        "frequency": [each.step for each in spectra],
    }
    ends = {"order": FITTED, "frequency": FITTED * fastest}
    found = [_best(spectra, kind, steps, ends[kind]) for kind, steps in grids.items()]
    best = min((line for line in found if line), key=lambda line: line.chance, default=None)
    return best if best and best.chance <= level / len(grids) else None


def _best(spectra: Sequence[Between], kind: str, steps: Sequence[float], end: float) -> Unnamed | None:
    """The best line of a grid on which the lines of each spectrum lie so far apart."""
    grid = np.arange(min(steps), end, min(steps) / 2)
    power = np.full((len(spectra), len(spectra[0].gauges), len(grid)), np.nan)
    for i, (each, step) in enumerate(zip(spectra, steps, strict=True)):
        line = np.round(grid / step).astype(int) - 1
        there = (line >= 0) & (line < len(each.clear))
        there[there] &= each.clear[line[there]]
        power[i][:, there] = each.power[:, line[there]]
    seen = np.isfinite(power).all(axis=1).sum(axis=0)
    freedom = 2 * power.shape[1] * seen
    gain = np.nansum(power, axis=(0, 1))
    # Half a line apart, and without the line's own neighbours.
    window = np.ones(4 * BESIDE + 1)
    window[2 * BESIDE - 3 : 2 * BESIDE + 4] = 0
    beside = np.convolve(freedom, window, "same") / 2
    noise = (np.convolve(gain, window, "same") / 2 + ALL_TOGETHER) / (beside + ALL_TOGETHER)
    # Some recordings do not have a frequency as a clear line; most must.
    tried = np.flatnonzero(seen > len(spectra) / 2)
    if not len(tried):
        return None
    chances = f.sf((gain / noise)[tried] / freedom[tried], freedom[tried], beside[tried] + ALL_TOGETHER) * len(tried)
    best = tried[int(np.argmin(chances))]
    amplitude = _amplitudes(spectra, power[:, :, best], [grid[best] / step for step in steps])
    largest = int(np.argmax(amplitude))
    return Unnamed(
        kind, float(grid[best]), float(amplitude[largest]), spectra[0].gauges[largest], float(min(1.0, chances.min()))
    )


def _amplitudes(
    spectra: Sequence[Between], power: Float[np.ndarray, "recording gauge"], position: Sequence[float]
) -> Float[np.ndarray, " gauge"]:
    """Amplitude of a line in every gauge [mV/V], root mean square over the recordings that show it."""
    squares = []
    for each, own, at in zip(spectra, power, position, strict=True):
        if np.isfinite(own).all():
            scale = each.scale[:, round(at) - 1]
            squares.append(4 * np.maximum(own - 2, 0) / scale**2)
    return np.sqrt(np.mean(squares, axis=0))
