"""Pictures that judge methods: detection, calibration, selective decisions, and comparisons."""

from collections.abc import Mapping
from textwrap import fill

import numpy as np
import pandas as pd
from jaxtyping import Bool
from matplotlib.axes import Axes

from learn.evaluation.decisions import truth
from learn.evaluation.detection_curve import FOUND, detection
from learn.protocols.fault_size import SIZES, size
from swgsim.common import style

# A class to the name of its fault's size, its unit, and the factor to that unit.
SIZE_AXES: Mapping[str, tuple[str, str, float]] = {
    "reduced_damping": ("lost linear damping b1", "%", 100),
    "reduced_stiffness": ("lost linear stiffness k1", "%", 100),
    "eccentric_wave_generator": ("eccentricity", "µm", 1e6),
    "root_tooth_crack": ("added compliance of a tooth pitch", "-", 1),
    "tip_tooth_crack": ("lost tooth force", "%", 100),
}
METHOD_COLOURS = ("#000000", "#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9", "#CC79A7")
METHOD_MARKERS = ("o", "s", "^", "D", "v", "P", "X")
POINTS = 8
TITLE_WIDTH = 50


def pod_curves(predictions: pd.DataFrame, hits: Bool[np.ndarray, " row"]) -> style.Picture:
    """Probability of detection against fault size for every fault class, over all operating points.

    Parameters
    ----------
    predictions : DataFrame
    hits : array (row,) of bool
        :func:`detection.detected` or :func:`detection.identified` of these predictions.
    """
    labels = [label for label in SIZES if (truth(predictions) == label).any()]
    columns = min(3, len(labels))
    rows = -(-len(labels) // columns)
    picture = style.figure(max(5.0, 4 * columns), 3.6 * rows + 0.5)
    for place, label in enumerate(labels, start=1):
        _detection_panel(picture.add_subplot(rows, columns, place), predictions, hits, label)
    handles = {text: h for axes in picture.axes for h, text in zip(*axes.get_legend_handles_labels(), strict=True)}
    picture.legend(list(handles.values()), list(handles), ncols=5, loc="outside upper center", fontsize=9)
    return style.Picture(
        "How large a fault must be to be found",
        "Circles are observed shares of recordings, the curve is the fitted probability with its one-sided 95 % bounds "
        "from the scatter between gears. Look where the lower bound crosses 90 % (a90/95): from this size on a fault "
        "is found with that certainty; a curve that stays flat or low means that the fault hides.",
        style.png(picture),
    )


def _detection_panel(axes: Axes, predictions: pd.DataFrame, hits: Bool[np.ndarray, " row"], label: str) -> None:
    """Observed shares, curve with band, and the sizes that are found, of one class."""
    rows = truth(predictions) == label
    name, unit, factor = SIZE_AXES[label]
    sizes = factor * size(label, predictions["severity"].to_numpy(dtype=float)[rows])
    ending = "" if unit == "-" else f" {unit}"
    fitted = detection(sizes, hits[rows], predictions["gear"].to_numpy()[rows], ending)
    groups = [group for group in np.array_split(np.argsort(sizes, kind="stable"), POINTS) if len(group)]
    middle = [np.exp(np.log(sizes[group]).mean()) for group in groups]
    observed = [100 * hits[rows][group].mean() for group in groups]
    axes.plot(middle, observed, "o", color="#555555", markerfacecolor="white", markersize=5, label="observed")
    if fitted.curve is not None:
        x = np.geomspace(sizes.min(), sizes.max(), 200)
        low, centre, high = (100 / (1 + np.exp(-fitted.curve.log_odds(x, side))) for side in (-1, 0, 1))
        axes.fill_between(x, low, high, color="#999999", alpha=0.35, linewidth=0, label="95 % bounds")
        axes.plot(x, centre, color=style.CLASS_COLOURS[label], linewidth=1.8)
    axes.axhline(100 * FOUND, color="#999999", linewidth=0.8, linestyle=":")
    said = [style.words(label)]
    for text, key, dashes in (("a90", "a90", "--"), ("a90/95", "a90_95", "-.")):
        value = getattr(fitted, key)
        said.append(fill(f"{text}: {fitted.reasons.get(key, f'{value:.3g}{ending}')}", TITLE_WIDTH))
        if np.isfinite(value):
            axes.axvline(value, color="black", linewidth=1.1, linestyle=dashes, label=text)
    axes.set(xscale="log", ylim=(-4, 104))
    _few_ticks(axes, float(sizes.min()), float(sizes.max()))
    style.label(axes, f"{name} [{unit}]", "found [%]", "\n".join(said))
    axes.title.set_fontsize(8.5)


def _few_ticks(axes: Axes, low: float, high: float) -> None:
    """Four plain numbers on a logarithmic axis, whose own ticks may be one or a dozen."""
    ticks = np.unique([float(f"{tick:.2g}") for tick in np.geomspace(low, high, 4)])
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)


def reliability_diagram(tables: Mapping[str, pd.DataFrame]) -> style.Picture:
    """Accuracy against confidence; one table of :func:`probability_calibration.reliability` per method."""
    from learn.evaluation.probability_calibration import expected_calibration_error

    picture = style.figure(6, 5.2 + 0.22 * len(tables))
    axes = picture.add_subplot()
    axes.plot([0, 100], [0, 100], color="#999999", linewidth=1, linestyle=":", label="as sure as right")
    for (name, table), colour, marker in zip(tables.items(), METHOD_COLOURS, METHOD_MARKERS, strict=False):
        text = f"{name} (error {expected_calibration_error(table):.1f} points)"
        x, y = 100 * table["confidence"], 100 * table["accuracy"]
        axes.plot(x, y, f"{marker}-", color=colour, markersize=5, linewidth=1.2, label=text)
    lowest = min(100 * min(table["confidence"].min(), table["accuracy"].min()) for table in tables.values())
    axes.set(xlim=(max(0, lowest - 5), 101), ylim=(max(0, lowest - 5), 102))
    style.label(axes, "confidence: highest probability [%]", "accuracy [%]")
    picture.legend(loc="outside lower center", fontsize=9)
    return style.Picture(
        "Is a sure decision a right one?",
        "Every marker is one bin of equally many recordings. Below the dotted line a method is surer than it is right, "
        "which is the dangerous side; look at the right end, where decisions are taken without a second look.",
        style.png(picture),
    )


def risk_coverage_curves(curves: Mapping[str, pd.DataFrame]) -> style.Picture:
    """Errors against share decided; one curve of :func:`learn.evaluation.selective.risk_coverage` per method."""
    from learn.evaluation.selective import area_under_risk, coverage_at

    picture = style.figure(6.6, 4.2 + 0.22 * len(curves))
    axes = picture.add_subplot()
    for (name, curve), colour in zip(curves.items(), METHOD_COLOURS, strict=False):
        decided = 100 * coverage_at(curve, 0.05)
        text = f"{name} (area {100 * area_under_risk(curve):.2f} %, {decided:.0f} % decided at 5 % error)"
        axes.step(100 * curve["coverage"], 100 * curve["risk"], where="post", color=colour, linewidth=1.5, label=text)
    for error in (1, 5):
        axes.axhline(error, color="#999999", linewidth=0.9, linestyle=":")
        axes.annotate(f"{error} %", (0, error), xytext=(2, 2), textcoords="offset points", fontsize=8, color="#555555")
    axes.set(xlim=(0, 100), ylim=(0, None))
    style.label(axes, "share of recordings decided, the surest first [%]", "wrong among these [%]")
    picture.legend(loc="outside lower center", fontsize=9)
    return style.Picture(
        "What is gained by leaving unsure recordings undecided",
        "From right to left ever fewer, surer recordings are decided. Look where a curve crosses the dotted lines of "
        "1 % and 5 %: so many recordings could be decided; a curve that does not fall towards the left has a "
        "confidence that is worth nothing.",
        style.png(picture),
    )


def difference_forest(comparison: pd.DataFrame, by_gear: pd.DataFrame, reference: str) -> style.Picture:
    """Difference of every method to a reference with its interval.

    Parameters
    ----------
    comparison : DataFrame
        Of :func:`learn.evaluation.bootstrap.paired_comparison`.
    by_gear : DataFrame
        Differences of every gear (rows) for each method (columns) [points].
    reference : str
        Name of the method compared to.
    """
    ordered = comparison.sort_values("value", ascending=False)
    picture = style.figure(9, 0.5 * len(ordered) + 1.5)
    axes = picture.add_subplot()
    axes.axvline(0, color="#999999", linewidth=1)
    for row, (name, found) in enumerate(ordered.iterrows()):
        axes.plot(by_gear[name], np.full(len(by_gear), row - 0.22), "|", color="#56B4E9", markersize=7)
        if np.isfinite(found["low"]):
            axes.plot([found["low"], found["high"]], [row, row], color="black", linewidth=1.6)
        axes.plot(found["value"], row, "o", color="black", markersize=6)
        text = f"p = {found['p_holm']:.3f}" if np.isfinite(found["p_holm"]) else "too few gears"
        gears = f"better in {found['better_gears']:.0f} of {found['gears']:.0f} gears"
        axes.annotate(f"{text}, {gears}", (1.02, row), xycoords=("axes fraction", "data"), va="center", fontsize=8.5)
    axes.set_yticks(range(len(ordered)), list(ordered.index))
    axes.set_ylim(-0.6, len(ordered) - 0.4)
    style.label(axes, f"error minus that of {reference} [points]; left is better", "")
    return style.Picture(
        f"Which methods differ from {reference}",
        "Mean difference on the same specimens with its 95 % interval from gears drawn anew; the blue strokes are "
        "single gears. Look for intervals that keep clear of 0; the p values are corrected for the number of methods "
        "(Holm).",
        style.png(picture),
    )
