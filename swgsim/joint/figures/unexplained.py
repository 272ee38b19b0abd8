"""Picture: lines that remain in the residual, over speed, and their laws."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from scipy.signal import find_peaks, periodogram

from swgsim.common import style
from swgsim.joint.figures.parts import WIDTH, one_way, tables, unit
from swgsim.joint.judged import Judged
from swgsim.joint.remaining import RemainingLine
from swgsim.joint.slow import SLOW

# Largest number of lines of a recording, and smallest line as a share of the largest of all.
STRONGEST, SMALLEST = 10, 0.08
LARGEST_DOT = 220.0
LAWS = ("#D55E00", "#0072B2", "#009E73")
STYLES = ("-", "--", "-.")


def unexplained(judged: Judged, lines: Sequence[RemainingLine]) -> Figure:
    """Frequency of the strongest lines of every run in one direction over its speed, with the laws found."""
    speed, frequency, size = (np.array(part) for part in zip(*_peaks(judged), strict=True))
    shown = size > SMALLEST * size.max()
    picture = style.figure(WIDTH, 4.8)
    axes = picture.subplots()
    area = LARGEST_DOT * (size / size.max())[shown]
    axes.scatter(speed[shown], frequency[shown], s=area, color="#777777", alpha=0.6, linewidths=0)
    highest = 1.05 * float(frequency[shown].max())
    grid = np.linspace(0, 1.05 * float(speed.max()), 400)
    for number, line in enumerate(lines):
        along = np.abs(line.fixed + line.order * grid / (2 * np.pi))
        colour, dashes = LAWS[number % len(LAWS)], STYLES[number % len(STYLES)]
        axes.plot(grid, along, dashes, color=colour, linewidth=1.4, label=_law(line))
    axes.set_ylim(0, highest)
    axes.set_xlim(0, grid[-1])
    style.label(
        axes, "mean speed of the joint [rad/s]", "frequency [Hz]", f"largest dot: {size.max():.2g} {unit(judged)}"
    )
    picture.legend(*axes.get_legend_handles_labels(), ncols=1, loc="outside upper center", fontsize=9)
    return picture


def _law(line: RemainingLine) -> str:
    """A law as a formula."""
    if not line.fixed:
        return f"order {line.order:.4g} per revolution of the output"
    if not line.order:
        return f"{line.fixed:.3g} Hz at every speed"
    return f"{line.fixed:.3g} Hz {'-' if line.order < 0 else '+'} order {abs(line.order):.4g}"


def _peaks(judged: Judged) -> list[tuple[float, float, float]]:
    """Speed, frequency and amplitude of the strongest lines in the residual of runs in one direction."""
    found = []
    for table, _ in tables(judged):
        missed = judged.ladder.top.missed(table)
        for number, each in enumerate(table.recordings):
            own = missed[table.run == number]
            if one_way(each):
                f, power = periodogram(own, each.rate, window="hann", scaling="spectrum")
                peaks = find_peaks(power)[0]
                peaks = peaks[f[peaks] > SLOW]
                for i in peaks[np.argsort(power[peaks])[-STRONGEST:]]:
                    found.append((float(np.abs(each.speed).mean()), float(f[i]), float(np.sqrt(2 * power[i]))))
    return found
