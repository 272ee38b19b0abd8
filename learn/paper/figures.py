"""Pictures of the learning: spectra, the disturbance, and the classes that the random forest recognises."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from jaxtyping import Float
from matplotlib.figure import Figure

from swgsim.common import style
from swgsim.storage.labelled_signals import CLASSES, SENSORS, LabelledSignals
from swgsim.storage.orders import whole_revolutions

HIGHEST_ORDER = 8
TABLES: Mapping[str, str] = {
    "table7": "VII, same gears, clean",
    "table8": "VIII, same gears, disturbed",
    "table9": "IX, new gear, clean",
    "table10": "X, new gear, disturbed",
}


def pictures(
    examples: Mapping[str, Float[np.ndarray, "5 time"]],
    speed_rpm: float,
    clean: LabelledSignals,
    disturbed: LabelledSignals,
    runs: pd.DataFrame,
) -> list[style.Picture]:
    """All pictures of this module; the parameters are those of the functions below."""
    ratio = np.abs(disturbed.signals[0] - clean.signals[0]).max() / np.ptp(clean.signals[0], axis=1).max() * 2
    return [
        style.Picture(
            "Fig. 7: DFT of different sensor signals",
            "Magnitude at the multiples of the input speed, on a logarithmic scale. Order 2 comes from the two lobes "
            "of the wave generator: it dominates s1 (b) and is far smaller in the differences (c, d). There the three "
            "faults of the flex spline stand out at even orders, the tip crack least. Reduced damping and stiffness "
            "equal the healthy gear.",
            style.png(spectra(examples, speed_rpm, clean.rate)),
        ),
        style.Picture(
            "Fig. 8: non-disturbed and disturbed data",
            f"A healthy recording without and with the disturbance of eq. (10), which is at most {100 * ratio:.2f} % "
            "of the largest signal's amplitude. Left: the curves coincide. Right: the difference shows the offset and "
            "the sub-harmonics, of which two are not periodic in the window.",
            style.png(disturbance(clean, disturbed)),
        ),
        style.Picture(
            "What the random forest recognises",
            "Recall of each class, for every row of the paper's tables (new gear: mean of the three). Dark cells are "
            "classes that the features do not separate from others.",
            style.png(recall(runs)),
        ),
    ]


def spectra(examples: Mapping[str, Float[np.ndarray, "5 time"]], speed_rpm: float, rate: float) -> Figure:
    """Fig. 7: DFT magnitude of s0, s1, s1 - s3 and s2 - s4 over f / n_in.

    Parameters
    ----------
    examples : mapping
        Class to signals [mV/V].
    speed_rpm : float
        Speed of the wave generator.
    rate : float
        Sampling rate [Hz].
    """
    picture = style.figure(11, 7.5)
    panels = picture.subplots(2, 2, sharex=True)
    channels = {
        "(a) s0": lambda s: s[0],
        "(b) s1": lambda s: s[1],
        "(c) s1 - s3": lambda s: s[1] - s[3],
        "(d) s2 - s4": lambda s: s[2] - s[4],
    }
    for axes, (title, channel) in zip(panels.flat, channels.items(), strict=True):
        for place, (label, signals) in enumerate(examples.items()):
            order, magnitude = spectrum(channel(signals), speed_rpm, rate)
            near = np.isclose(order % 1, 0) & (order > 0) & (order <= HIGHEST_ORDER)
            x = order[near] + 0.11 * (place - (len(examples) - 1) / 2)
            colour = style.CLASS_COLOURS[label]
            axes.vlines(x, 1e-7, magnitude[near], color=colour, linewidth=1.6)
            axes.plot(x, magnitude[near], "o", color=colour, markersize=4.5, label=style.words(label))
        axes.set(yscale="log", ylim=(1e-6, 0.5), xticks=range(1, HIGHEST_ORDER + 1))
        style.label(axes, "", "magnitude [mV/V]", title)
    for axes in panels[1]:
        axes.set_xlabel("f / n_in [-]")
    picture.legend(*panels[0, 0].get_legend_handles_labels(), ncols=6, loc="outside upper center", fontsize=9)
    return picture


def spectrum(
    signal: Float[np.ndarray, " time"], speed_rpm: float, rate: float
) -> tuple[Float[np.ndarray, " line"], Float[np.ndarray, " line"]]:
    """Orders of the wave generator and DFT magnitudes of the zero-mean signal over whole revolutions."""
    length = whole_revolutions(speed_rpm, rate, len(signal))
    part = signal[:length] - signal[:length].mean()
    return np.fft.rfftfreq(length, speed_rpm / 60 / rate), np.abs(np.fft.rfft(part)) * 2 / length


def disturbance(clean: LabelledSignals, disturbed: LabelledSignals) -> Figure:
    """Fig. 8: the same recording clean and disturbed, and the difference on its own scale."""
    time = 1e3 * np.arange(clean.signals.shape[2]) / clean.rate
    picture = style.figure(11, 3.8)
    left, right = picture.subplots(1, 2)
    for name, colour, s, d in zip(SENSORS, style.SENSOR_COLOURS.values(), clean.signals[0], disturbed.signals[0],
                                  strict=True):  # fmt: skip
        left.plot(time, s, color=colour, linewidth=2.6, alpha=0.35)
        left.plot(time, d, color=colour, linewidth=1.1, linestyle="--", label=name)
        right.plot(time, 1e3 * (d - s), color=colour, linewidth=1.2)
    picture.legend(*left.get_legend_handles_labels(), ncols=5, loc="outside upper center")
    style.label(left, "time [ms]", "signal [mV/V]", "clean (broad), disturbed (dashed)")
    style.label(right, "time [ms]", "disturbed - clean [µV/V]", "difference, own scale")
    return picture


def recall(runs: pd.DataFrame) -> Figure:
    """Share of every class that the random forest recognises in each experiment of the paper's tables."""
    forest = runs[(runs["classifier"] == "rf") & (runs["protocol"] != "grouped_folds")]
    forest = forest.sort_values(["study", "features"], key=lambda column: column.str.extract(r"(\d+)")[0].astype(int))
    shares = forest[[f"recall/{label}" for label in CLASSES]].to_numpy()
    picture = style.figure(9, 0.42 * len(forest) + 1.6)
    axes = picture.add_subplot()
    drawn = axes.imshow(shares, cmap="cividis", vmin=50, vmax=100, aspect="auto")
    for (row, column), share in np.ndenumerate(shares):
        axes.text(column, row, f"{share:.1f}", ha="center", va="center", color="black" if share > 80 else "white")
    names = forest["study"].map(TABLES) + ", " + forest["features"].str.replace("_", " ")
    axes.set_yticks(range(len(forest)), names)
    axes.set_xticks(range(len(CLASSES)), [style.words(label).replace(" ", "\n") for label in CLASSES])
    picture.colorbar(drawn, ax=axes, label="recognised [%]", extend="min")
    return picture
