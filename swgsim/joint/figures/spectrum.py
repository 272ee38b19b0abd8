"""Picture: density of the residual over frequency, before and after."""

import numpy as np
from jaxtyping import Float
from matplotlib.figure import Figure
from scipy.signal import welch

from swgsim.common import style
from swgsim.joint.figures.parts import AFTER, BEFORE, FLOOR, WIDTH, logarithmic, unit
from swgsim.joint.judged import Judged
from swgsim.joint.regression import Table
from swgsim.joint.slow import SLOW

# Length of a segment of the spectrum [s]; a shorter recording is one segment.
STRETCH = 4.0


def spectrum(judged: Judged) -> Figure:
    """Spectral density of the residuals of both models on held-out recordings."""
    picture = style.figure(WIDTH, 3.6)
    axes = picture.subplots()
    for fit, colour, label in (
        (judged.ladder.textbook, BEFORE, "textbook model"),
        (judged.ladder.top, AFTER, "with the effects found"),
    ):
        f, power = density(judged.heldout, fit.missed(judged.heldout))
        axes.loglog(f, np.sqrt(power), color=colour, label=label, linewidth=1.2)
    if judged.floor is not None:
        rate = min(each.rate for each in judged.heldout.recordings)
        level = judged.floor / np.sqrt(rate / 2)
        axes.axhline(level, color=FLOOR, linestyle="--", label="noise at rest, spread evenly")
    axes.axvline(SLOW, color="#999999", linewidth=0.8, linestyle=":")
    axes.text(
        SLOW, 0.98, f" {SLOW:g} Hz", transform=axes.get_xaxis_transform(), va="top", fontsize=7.5, color="#666666"
    )
    axes.margins(x=0)
    logarithmic(axes.xaxis)
    logarithmic(axes.yaxis)
    style.label(axes, "frequency [Hz]", f"density of the residual [{unit(judged)}/√Hz]")
    picture.legend(*axes.get_legend_handles_labels(), ncols=2, loc="outside upper center", fontsize=9)
    return picture


def density(
    table: Table, residual: Float[np.ndarray, " row"]
) -> tuple[Float[np.ndarray, " frequency"], Float[np.ndarray, " frequency"]]:
    """Power spectral density without the mean, averaged over all recordings by their lengths."""
    stretch = min(STRETCH, min(float(each.time[-1] - each.time[0]) for each in table.recordings))
    highest = min(each.rate for each in table.recordings) / 2
    grid = np.arange(1, int(highest * stretch)) / stretch
    total = np.zeros(len(grid))
    for number, each in enumerate(table.recordings):
        own = residual[table.run == number]
        f, power = welch(own, each.rate, nperseg=min(len(own), round(stretch * each.rate)), detrend="constant")
        total += len(own) * np.interp(grid, f, power)
    return grid, total / len(residual)
