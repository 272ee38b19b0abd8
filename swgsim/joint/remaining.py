"""Lines that remain in the residual of runs at steady speed: their frequency over speed, and their coherence."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from jaxtyping import Float
from scipy.signal import find_peaks, periodogram

from swgsim.common.seeds import generator
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Fit, Table, rms

# Speeds whose standard deviation is below this share of the mean are steady.
STEADY_SPEED = 0.1
# Power of a line relative to the noise near it, and largest number of lines in a run.
STRONG, MOST_LINES = 30.0, 8
# Relative accuracy of frequencies, as that of estimated clocks; lines this near to a law follow it.
MET = 0.03
# A line needs so many resolutions of the run in frequency; below is drift.
LEAST_RESOLUTIONS = 5
# Least number of runs of a law, and largest number of laws.
LEAST_RUNS, MOST_LAWS = 4, 3
# Lines within so many tolerances of a law belong to its skirt.
SKIRT = 3.0
# Permutations of the speeds of the runs, which give the number of runs that a law meets by chance (level 1 in 20).
PERMUTATIONS = 19
# Rounds of the refinement of a law.
REFINED = 3
# A fixed part below this share of the largest frequency counts as zero.
ZERO_FREQUENCY = 0.05
# Oversampling of the resolution of half of a run.
FINER = 16


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
        The largest amplitude, in the unit of the signal.
    speed : float
        Speed of the run with this amplitude [rad/s].
    runs : tuple of str
        Names of the runs with the line.
    gain : float
        Relative reduction of the error of these runs if each half of a run is predicted from the other half; negative
        if the phase does not last.
    """

    fixed: float
    order: float
    amplitude: float
    speed: float
    runs: tuple[str, ...]
    gain: float

    def __str__(self) -> str:
        change = "lowers" if self.gain > 0 else "raises"
        where = (
            f"largest at {self.speed:.2g} rad/s ({self.amplitude:.2g}), in {len(self.runs)} runs; predicted from one "
            f"half of a run it {change} the error of the other by {100 * abs(self.gain):.2g} %"
        )
        if not self.fixed:
            return f"a wave of order {self.order:.4g} per revolution of the output, {where}"
        if not self.order:
            return f"a line at {self.fixed:.3g} Hz at every speed, {where}"
        if self.order < 0:
            law = f"less order {-self.order:.4g}, whose frequency falls with speed like an alias of a sampled wave"
        else:
            law = f"plus order {self.order:.4g}, whose frequency rises with speed"
        return f"a line at {self.fixed:.3g} Hz {law}, {where}"


@dataclass(frozen=True)
class Peak:
    """One line of one run: frequency [Hz], amplitude; name, speed [rad/s] and resolution [Hz] of the run."""

    frequency: float
    amplitude: float
    run: str
    speed: float
    resolution: float


def remaining(fits: Sequence[tuple[Fit, Table]]) -> tuple[RemainingLine, ...]:
    """Laws of lines that several runs share, the law with the most power first.

    Parameters
    ----------
    fits : sequence of (Fit, Table)
        A model, and recordings with a residual.
    """
    peaks = [peak for fit, table in fits for peak in significant_peaks(fit, table)]
    by_chance = _by_chance(peaks, generator("remaining lines"))
    found: list[RemainingLine] = []
    while len(found) < MOST_LAWS:
        best = _best(peaks)
        if best is None or _runs(best[0]) <= by_chance:
            break
        met, fixed, slope = best
        largest = max(met, key=lambda peak: peak.amplitude)
        runs = tuple(dict.fromkeys(p.run for p in met))
        gain = _gain(fits, runs, fixed, slope)
        found.append(RemainingLine(fixed, 2 * np.pi * slope, largest.amplitude, largest.speed, runs, gain))
        # Peaks near the law are its skirt.
        peaks = [peak for peak in peaks if _off(peak, fixed, slope) > SKIRT]
    return tuple(found)


def _gain(fits: Sequence[tuple[Fit, Table]], runs: Sequence[str], fixed: float, slope: float) -> float:
    """Relative reduction of the error of the runs with a line, each half of a run predicted from the other half."""
    before, after = [], []
    for fit, table in fits:
        missed = fit.missed(table)
        for number, each in enumerate(table.recordings):
            if each.name in runs:
                own = missed[table.run == number]
                doubt = MET * max(abs(fixed), abs(slope) * float(np.abs(each.speed).mean()))
                before.append(own)
                after.append(coherent_part_removed(each, own, fixed, 2 * np.pi * slope, doubt))
    return 1 - rms(np.concatenate(after)) / rms(np.concatenate(before))


def _by_chance(peaks: Sequence[Peak], rng: np.random.Generator) -> int:
    """Largest number of runs that a law meets by chance, after permutations of the speeds of the runs."""
    speeds = {peak.run: peak.speed for peak in peaks}
    most = LEAST_RUNS - 1
    for _ in range(PERMUTATIONS if len(speeds) >= LEAST_RUNS else 0):
        permuted = dict(zip(speeds, rng.permutation(list(speeds.values())).tolist(), strict=True))
        best = _best([replace(peak, speed=permuted[peak.run]) for peak in peaks], moving=True)
        most = max(most, _runs(best[0]) if best else 0)
    return most


def _best(peaks: Sequence[Peak], *, moving: bool = False) -> tuple[list[Peak], float, float] | None:
    """The law that meets lines of most runs, with the most power among these: its lines, fixed part and slope.

    A fixed frequency does not change with permuted speeds; ``moving`` excludes it.
    """
    if not peaks:
        return None
    f, v, resolution = np.array([[p.frequency, p.speed, p.resolution] for p in peaks]).T
    run = np.unique([p.run for p in peaks], return_inverse=True)[1]
    laws = np.array([law for one, other in combinations(peaks, 2) for law in _laws(one, other) if law[1] or not moving]
                    or [(0.0, 0.0)])  # fmt: skip
    tolerance = MET * np.maximum(np.abs(laws[:, :1]), np.abs(laws[:, 1:]) * v) + resolution
    near = np.abs(f - laws[:, :1] - laws[:, 1:] * v) < tolerance
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


def _runs(met: Sequence[Peak]) -> int:
    return len({peak.run for peak in met})


def significant_peaks(fit: Fit, table: Table) -> list[Peak]:
    """Significant lines in the residual of runs at steady speed."""
    missed = fit.missed(table)
    found = []
    for number, each in enumerate(table.recordings):
        mean = float(each.speed.mean())
        if abs(mean) < 1e-9 or float(each.speed.std()) > STEADY_SPEED * abs(mean):
            continue
        own = missed[table.run == number]
        f, power = periodogram(own - own.mean(), each.rate, window="hann", scaling="spectrum")
        width = max(3, len(f) // 20)
        noise = np.array([np.median(power[max(0, i - width) : i + width + 1]) for i in range(len(f))])
        places, _ = find_peaks(power / np.maximum(noise, 1e-300), height=STRONG)
        resolution = 2 / float(each.time[-1] - each.time[0])
        strongest = sorted((i for i in places if f[i] > LEAST_RESOLUTIONS * resolution), key=lambda i: -power[i])[
            :MOST_LINES
        ]
        found += [Peak(float(f[i]), float(np.sqrt(2 * power[i])), each.name, abs(mean), resolution) for i in strongest]
    return found


def _laws(one: Peak, other: Peak) -> list[tuple[float, float]]:
    """Laws through two lines: fixed frequency, order, or both; fixed part [Hz] and slope [Hz s/rad]."""
    found = [(0.0, one.frequency / one.speed), (one.frequency, 0.0)]
    if one.run != other.run and abs(one.speed - other.speed) > 0.1 * max(one.speed, other.speed):
        slope = (one.frequency - other.frequency) / (one.speed - other.speed)
        fixed = one.frequency - slope * one.speed
        change = abs(slope) * max(one.speed, other.speed)
        if fixed > ZERO_FREQUENCY * max(one.frequency, other.frequency) and change > 2 * MET * fixed:
            found.append((fixed, slope))
    return found


def _met(peaks: Sequence[Peak], fixed: float, slope: float) -> list[Peak]:
    """The lines that a law meets, one of each run."""
    met: dict[str, Peak] = {}
    for peak in peaks:
        if _off(peak, fixed, slope) < 1 and (peak.run not in met or peak.amplitude > met[peak.run].amplitude):
            met[peak.run] = peak
    return list(met.values())


def _off(peak: Peak, fixed: float, slope: float) -> float:
    """Distance of a line from a law, in units of its tolerance, which is relative to the larger part of the law."""
    tolerance = MET * max(abs(fixed), abs(slope) * peak.speed) + peak.resolution
    return abs(peak.frequency - fixed - slope * peak.speed) / tolerance


def _refined(met: Sequence[Peak], fixed: float, slope: float) -> tuple[float, float]:
    """Refine a law by least squares over all lines that it meets."""
    f, v = np.array([p.frequency for p in met]), np.array([p.speed for p in met])
    if not fixed:
        return 0.0, float((f * v).sum() / (v**2).sum())
    if not slope:
        return float(f.mean()), 0.0
    slope, fixed = np.polyfit(v, f, 1).tolist()
    return fixed, slope


def coherent_part_removed(
    recording: JointRecording, residual: Float[np.ndarray, " time"], fixed: float, order: float, doubt: float
) -> Float[np.ndarray, " time"]:
    """Residual of each half of a run without a line that is estimated from the other half.

    Amplitude, phase and exact frequency are free in every run, since its clock was not recorded. If the line keeps its
    phase, this lowers the error; if not, it raises it.

    Parameters
    ----------
    recording : JointRecording
    residual : array (time,)
    fixed, order : float
        The line's frequency is fixed + order * speed / (2 pi) [Hz].
    doubt : float
        Uncertainty of the frequency [Hz].
    """
    time = np.arange(len(residual)) / recording.rate
    way = recording.signals["q"] * np.sign(recording.speed.mean())
    wave = np.exp(1j * (2 * np.pi * fixed * time + order * way))
    remainder = residual.copy()
    halves = np.array_split(np.arange(len(residual)), 2)
    for known, unknown in (halves, halves[::-1]):
        number = FINER * len(known)
        sizes = 2 / len(known) * np.fft.fft((residual * wave.conj())[known], number)
        off = np.fft.fftfreq(number, 1 / recording.rate)
        best = int(np.where(np.abs(off) <= doubt, np.abs(sizes), -1.0).argmax())
        turned = np.exp(2j * np.pi * off[best] * (time - time[known[0]]))
        remainder[unknown] -= (sizes[best] * turned * wave).real[unknown]
    return remainder
