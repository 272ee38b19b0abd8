"""Lines that remain in the residual of runs at steady speed, and how their frequency goes with speed."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from scipy.signal import find_peaks, periodogram

from swgsim.common.seeds import generator
from swgsim.joint.coherence import foretold
from swgsim.joint.regression import Fit, Table, rms

# Speeds that vary by less than this share are steady.
STEADY = 0.1
# A line stands out of the noise beside it by this factor of power; so many are taken of a run.
STRONG, MOST_LINES = 30.0, 8
# Lines of different runs are the same if their law meets them to this share: that of clocks that were estimated.
MET = 0.03
# A line with fewer waves in a run, times two, is no line but a drift.
WAVES = 5
# A law holds for so many runs at least, and explains so many lines at most.
LEAST_RUNS, MOST_LAWS = 4, 3
# Lines so many times as far from a law as those that meet it may be are none of its own.
SKIRT = 3.0
# Deals of the speeds to the runs, which say how many runs a law meets by luck (one in twenty goes beyond).
DEALT = 19
# Rounds of a law and the lines that it meets.
REFINED = 3
# Shares of the fixed part, beside the largest frequency, that are none.
NOTHING = 0.05


@dataclass(frozen=True)
class RemainingLine:
    """Lines of several runs that follow one law: frequency = fixed + order * speed / (2 pi).

    Attributes
    ----------
    fixed : float
        [Hz].
    order : float
        Waves per revolution of the output; negative where the frequency falls with speed.
    amplitude : float
        The largest one, in the unit of the signal.
    speed : float
        Of the run where that is [rad/s].
    runs : tuple of str
        Names of the runs that show it.
    gain : float
        Share by which it lowers the error of those runs, each half of a run being told by the other; negative where its
        phase does not last, so that no model of it predicts.
    """

    fixed: float
    order: float
    amplitude: float
    speed: float
    runs: tuple[str, ...]
    gain: float

    def __str__(self) -> str:
        what = "lowers" if self.gain > 0 else "raises"
        where = (
            f"largest at {self.speed:.2g} rad/s ({self.amplitude:.2g}), in {len(self.runs)} runs; told by one half of "
            f"a run it {what} the error of the other by {100 * abs(self.gain):.2g} %"
        )
        if not self.fixed:
            return f"a wave of order {self.order:.4g} per revolution of the output, {where}"
        if not self.order:
            return f"a line at {self.fixed:.3g} Hz at every speed, {where}"
        side = "falls" if self.order < 0 else "rises"
        return (
            f"a line at {self.fixed:.3g} Hz less order {-self.order:.4g}, whose frequency {side} with speed "
            f"as the image of a wave in a sampled signal does, {where}"
            if self.order < 0 else
            f"a line at {self.fixed:.3g} Hz plus order {self.order:.4g}, whose frequency {side} with speed, {where}"
        )  # fmt: skip


@dataclass(frozen=True)
class _Peak:
    """One line of one run: frequency [Hz], amplitude, and of the run name, speed [rad/s] and resolution [Hz]."""

    frequency: float
    amplitude: float
    run: str
    speed: float
    resolution: float


def remaining(fits: Sequence[tuple[Fit, Table]]) -> tuple[RemainingLine, ...]:
    """Laws of lines that several runs share, the one with the most power first.

    Parameters
    ----------
    fits : sequence of (Fit, Table)
        A model and recordings of which it leaves something.
    """
    peaks = [peak for fit, table in fits for peak in _peaks(fit, table)]
    luck = _luck(peaks, generator("remaining lines"))
    found: list[RemainingLine] = []
    while len(found) < MOST_LAWS:
        best = _best(peaks)
        if best is None or _runs(best[0]) <= luck:
            break
        met, fixed, slope = best
        largest = max(met, key=lambda peak: peak.amplitude)
        runs = tuple(dict.fromkeys(p.run for p in met))
        gain = _gain(fits, runs, fixed, slope)
        found.append(RemainingLine(fixed, 2 * np.pi * slope, largest.amplitude, largest.speed, runs, gain))
        # What is near it is its skirt.
        peaks = [peak for peak in peaks if _off(peak, fixed, slope) > SKIRT]
    return tuple(found)


def _gain(fits: Sequence[tuple[Fit, Table]], runs: Sequence[str], fixed: float, slope: float) -> float:
    """Share by which a line lowers the error of the runs that show it, each half of a run being told by the other."""
    before, after = [], []
    for fit, table in fits:
        missed = fit.missed(table)
        for number, each in enumerate(table.recordings):
            if each.name in runs:
                own = missed[table.run == number]
                doubt = MET * max(abs(fixed), abs(slope) * float(np.abs(each.speed).mean()))
                before.append(own)
                after.append(foretold(each, own, fixed, 2 * np.pi * slope, doubt))
    return 1 - rms(np.concatenate(after)) / rms(np.concatenate(before))


def _luck(peaks: Sequence[_Peak], rng: np.random.Generator) -> int:
    """Most runs that a law meets when the speeds are dealt out to the runs anew: what many lines meet by luck."""
    speeds = {peak.run: peak.speed for peak in peaks}
    most = LEAST_RUNS - 1
    for _ in range(DEALT if len(speeds) >= LEAST_RUNS else 0):
        dealt = dict(zip(speeds, rng.permutation(list(speeds.values())).tolist(), strict=True))
        best = _best([replace(peak, speed=dealt[peak.run]) for peak in peaks], moving=True)
        most = max(most, _runs(best[0]) if best else 0)
    return most


def _best(peaks: Sequence[_Peak], *, moving: bool = False) -> tuple[list[_Peak], float, float] | None:
    """The law that meets lines of most runs, of most power among these: its lines, fixed part and slope.

    A fixed frequency is the same however speeds are dealt out; with ``moving`` it is no law.
    """
    if not peaks:
        return None
    f, v, resolution = np.array([[p.frequency, p.speed, p.resolution] for p in peaks]).T
    run = np.unique([p.run for p in peaks], return_inverse=True)[1]
    laws = np.array([law for one, other in combinations(peaks, 2) for law in _laws(one, other) if law[1] or not moving]
                    or [(0.0, 0.0)])  # fmt: skip
    may_be = MET * np.maximum(np.abs(laws[:, :1]), np.abs(laws[:, 1:]) * v) + resolution
    near = np.abs(f - laws[:, :1] - laws[:, 1:] * v) < may_be
    runs = np.stack([near[:, run == number].any(axis=1) for number in range(run.max() + 1)]).sum(axis=0)
    power = near @ np.array([p.amplitude**2 for p in peaks])
    fixed, slope = laws[np.lexsort((power, runs))[-1]].tolist()
    met = _met(peaks, fixed, slope)
    for _ in range(REFINED if met else 0):
        refined = _refined(met, fixed, slope)
        again = _met(peaks, *refined)
        if _runs(again) < _runs(met):
            break
        met, (fixed, slope) = again, refined
    return (met, fixed, slope) if _runs(met) >= LEAST_RUNS else None


def _runs(met: Sequence[_Peak]) -> int:
    return len({peak.run for peak in met})


def _peaks(fit: Fit, table: Table) -> list[_Peak]:
    """Lines that stand out of the residual of runs at steady speed."""
    missed = fit.missed(table)
    found = []
    for number, each in enumerate(table.recordings):
        mean = float(each.speed.mean())
        if abs(mean) < 1e-9 or float(each.speed.std()) > STEADY * abs(mean):
            continue
        own = missed[table.run == number]
        f, power = periodogram(own - own.mean(), each.rate, window="hann", scaling="spectrum")
        width = max(3, len(f) // 20)
        noise = np.array([np.median(power[max(0, i - width) : i + width + 1]) for i in range(len(f))])
        places, _ = find_peaks(power / np.maximum(noise, 1e-300), height=STRONG)
        resolution = 2 / float(each.time[-1] - each.time[0])
        strongest = sorted((i for i in places if f[i] > WAVES * resolution), key=lambda i: -power[i])[:MOST_LINES]
        found += [_Peak(float(f[i]), float(np.sqrt(2 * power[i])), each.name, abs(mean), resolution) for i in strongest]
    return found


def _laws(one: _Peak, other: _Peak) -> list[tuple[float, float]]:
    """Laws that two lines suggest: fixed frequency, order, or both; fixed part [Hz] and slope [Hz s/rad]."""
    found = [(0.0, one.frequency / one.speed), (one.frequency, 0.0)]
    if one.run != other.run and abs(one.speed - other.speed) > 0.1 * max(one.speed, other.speed):
        slope = (one.frequency - other.frequency) / (one.speed - other.speed)
        fixed = one.frequency - slope * one.speed
        change = abs(slope) * max(one.speed, other.speed)
        if fixed > NOTHING * max(one.frequency, other.frequency) and change > 2 * MET * fixed:
            found.append((fixed, slope))
    return found


def _met(peaks: Sequence[_Peak], fixed: float, slope: float) -> list[_Peak]:
    """The lines that a law meets, one of each run."""
    met: dict[str, _Peak] = {}
    for peak in peaks:
        if _off(peak, fixed, slope) < 1 and (peak.run not in met or peak.amplitude > met[peak.run].amplitude):
            met[peak.run] = peak
    return list(met.values())


def _off(peak: _Peak, fixed: float, slope: float) -> float:
    """Distance of a line from a law, in units of what may be; fixed and moving part are each known to a share only."""
    may_be = MET * max(abs(fixed), abs(slope) * peak.speed) + peak.resolution
    return abs(peak.frequency - fixed - slope * peak.speed) / may_be


def _refined(met: Sequence[_Peak], fixed: float, slope: float) -> tuple[float, float]:
    """A law by least squares over all lines that it meets."""
    f, v = np.array([p.frequency for p in met]), np.array([p.speed for p in met])
    if not fixed:
        return 0.0, float((f * v).sum() / (v**2).sum())
    if not slope:
        return float(f.mean()), 0.0
    slope, fixed = np.polyfit(v, f, 1).tolist()
    return fixed, slope
