"""Picture: lines that remain in the residual, over speed, and their laws."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from swgsim.common import style
from swgsim.joint.figures.parts import WIDTH, tables, unit
from swgsim.joint.remaining import RemainingLine, significant_peaks
from swgsim.joint.validation import Validation

# Area of the largest dot.
LARGEST_DOT = 220.0
LAWS = ("#D55E00", "#0072B2", "#009E73")
STYLES = ("-", "--", "-.")


def unexplained(validation: Validation, lines: Sequence[RemainingLine]) -> Figure | None:
    """Frequency of the significant lines of every steady run over its speed, with their laws; None without lines."""
    peaks = [peak for table, _ in tables(validation) for peak in significant_peaks(validation.ladder.top, table)]
    if not peaks:
        return None
    speed, frequency, size = np.array([(peak.speed, peak.frequency, peak.amplitude) for peak in peaks]).T
    picture = style.figure(WIDTH, 4.8)
    axes = picture.subplots()
    axes.scatter(speed, frequency, s=LARGEST_DOT * size / size.max(), color="#777777", alpha=0.6, linewidths=0)
    grid = np.linspace(0, 1.05 * float(speed.max()), 400)
    for number, line in enumerate(lines):
        along = np.abs(line.fixed + line.order * grid / (2 * np.pi))
        colour, dashes = LAWS[number % len(LAWS)], STYLES[number % len(STYLES)]
        axes.plot(grid, along, dashes, color=colour, linewidth=1.4, label=_law(line))
    axes.set_ylim(0, 1.05 * float(frequency.max()))
    axes.set_xlim(0, grid[-1])
    style.label(
        axes, "mean speed of the joint [rad/s]", "frequency [Hz]", f"largest dot: {size.max():.2g} {unit(validation)}"
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
