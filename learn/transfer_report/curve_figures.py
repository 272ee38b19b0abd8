"""Curves of all methods against the number of labelled variants: error and forgetting."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from learn.transfer_report.line_ends import GREY, End, name_ends
from swgsim.common import style

FORESTS = ("random forest", "rf", "extra trees")  # begin the names of these classifiers
FROM_SCRATCH = "from scratch"
FORGOTTEN_LIMIT = 2.0  # points of accuracy
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#000000")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")  # one more than colours, so that pairs repeat late
DASHES = ("-", "--", ":", "-.")  # classifiers of one panel
ERROR_TICKS = (0, 0.5, 1, 2, 3, 5, 7, 10, 15, 20, 30, 40, 50, 70, 100)
FORGOTTEN_TICKS = (-50, -20, -10, -5, -2, -1, 0, 1, 2, 3, 5, 10, 20, 30, 50, 100)


def parts_of(method: str) -> tuple[str, str]:
    """Classifier and adaptation of a method.

    >>> parts_of("perceptron: fine tuning")
    ('perceptron', 'fine tuning')
    >>> parts_of("perceptron")
    ('perceptron', '')
    """
    classifier, _, adaptation = method.partition(":")
    return classifier.strip(), adaptation.strip()


def require_rows(frame: pd.DataFrame, column: str) -> pd.DataFrame:
    """The rows that have a value in this column.

    Raises
    ------
    ValueError
        If there is none.
    """
    known = frame.dropna(subset=[column])
    if known.empty:
        raise ValueError(f"0 of {len(frame)} rows have a value of {column!r}, a picture needs 1: run the jobs first")
    return known


def error(curves: pd.DataFrame, levels: Mapping[str, float]) -> Figure:
    """Error with its 95 % interval against labelled variants, networks left and forests right.

    Parameters
    ----------
    curves : DataFrame
        Columns method, shots, error, low, high [%]; a missing interval is left out.
    levels : mapping
        Name to error [%], drawn as horizontal lines.

    Raises
    ------
    ValueError
        If no row has an error.
    """
    known = require_rows(curves, "error").rename(columns={"error": "value"})
    return _small_multiples(known, levels, "error [%], logarithmic above 1 %", 1, ERROR_TICKS)


def forgotten(curves: pd.DataFrame) -> Figure:
    """Accuracy lost on the source gears against labelled variants, with its limit.

    Parameters
    ----------
    curves : DataFrame
        Columns method, shots, forgotten [points].

    Raises
    ------
    ValueError
        If no row has a value.
    """
    known = require_rows(curves, "forgotten").rename(columns={"forgotten": "value"})
    limit = {f"limit, {FORGOTTEN_LIMIT:g} points": FORGOTTEN_LIMIT}
    name = f"accuracy lost on source gears [points],\nlogarithmic above {FORGOTTEN_LIMIT:g} points"
    return _small_multiples(known.assign(low=np.nan, high=np.nan), limit, name, FORGOTTEN_LIMIT, FORGOTTEN_TICKS)


def _small_multiples(
    curves: pd.DataFrame, levels: Mapping[str, float], name: str, linear_below: float, ticks: Sequence[float]
) -> Figure:
    """Networks left, forests right; a panel without methods is left out."""
    is_forest = curves["method"].map(lambda method: method.startswith(FORESTS))
    groups = [group for group in (curves[~is_forest], curves[is_forest]) if len(group)]
    levels = {text: value for text, value in levels.items() if np.isfinite(value)}
    picture = style.figure(6.8 * len(groups), 6.2)
    picture.set_layout_engine("constrained", w_pad=0.12)
    panels = picture.subplots(1, len(groups), sharey=True, squeeze=False)[0]
    panels[0].set_yscale("symlog", linthresh=linear_below)
    panels[0].margins(y=0.05)
    drawn = [_draw(axes, group, levels) for axes, group in zip(panels, groups, strict=True)]
    panels[0].autoscale_view()
    low, high = panels[0].get_ylim()
    shown = [tick for tick in ticks if low <= tick <= high]
    for axes, group, ends in zip(panels, groups, drawn, strict=True):
        if len(shown) > 1:
            axes.set_yticks(shown, [f"{tick:g}" for tick in shown])
        axes.set_yticks([], minor=True)
        place = _places(group["shots"])
        axes.set_xticks(list(place.values()), _shot_names(list(place), int(curves["shots"].max())))
        axes.set_xlim(-0.45, max(place.values()) + 0.5)
        classifiers = dict.fromkeys(parts_of(method)[0] for method in group["method"])
        style.label(axes, "labelled variants of each class, K", "", ", ".join(classifiers))
        beside = [end for end in ends if end.x > 0.5 or max(place.values()) == 0]
        at_zero = [replace(end, text=end.text.replace(": ", ":\n")) for end in ends if end not in beside]
        name_ends(axes, beside)
        name_ends(axes, at_zero, inside=True)
    panels[0].set_ylabel(name)
    return picture


def _places(shots: pd.Series) -> dict[int, float]:
    """Places of the numbers of shots; beside 0 there is room for the names of methods that use no labels."""
    numbers = sorted({int(number) for number in shots})
    room = 1.3 if numbers[0] == 0 else 0.0
    return {number: place + (room if number else 0) for place, number in enumerate(numbers)}


def _shot_names(numbers: Sequence[int], largest: int) -> list[str]:
    """The largest number of all panels is all labels there are; 0 is never that."""
    return [f"{number}\nall (Z4)" if 0 < number == largest else f"{number}" for number in numbers]


def _draw(axes: Axes, curves: pd.DataFrame, levels: Mapping[str, float]) -> list[End]:
    """Curves of all methods, side by side at every number of shots, and the levels."""
    methods = list(dict.fromkeys(curves["method"]))
    classifiers = list(dict.fromkeys(parts_of(method)[0] for method in methods))
    adaptations = [a for a in dict.fromkeys(parts_of(method)[1] for method in methods) if a != FROM_SCRATCH]
    place = _places(curves["shots"])
    edge = max(place.values()) + 0.5
    ends = []
    for text, value in levels.items():
        axes.axhline(value, color="#444444", linewidth=1.1, linestyle=(0, (6, 2)), zorder=1)
        ends.append(End(text, edge, value, "#444444"))
    for number, method in enumerate(methods):
        classifier, adaptation = parts_of(method)
        rows = curves[curves["method"] == method].sort_values("shots")
        side = 0.44 * (number - (len(methods) - 1) / 2) / max(len(methods) - 1, 1)
        x = rows["shots"].map(lambda shots: place[int(shots)]).to_numpy() + side
        index = -1 if adaptation == FROM_SCRATCH else adaptations.index(adaptation)
        colour = GREY if index < 0 else COLOURS[index % len(COLOURS)]
        dashes = DASHES[classifiers.index(classifier) % len(DASHES)]
        axes.vlines(x, rows["low"], rows["high"], color=colour, linewidth=1.1, alpha=0.6, zorder=2)
        axes.plot(x, rows["value"], marker=MARKERS[index % len(MARKERS)], markersize=5, linestyle=dashes, label=method,
                  color=colour, linewidth=2.2 if index < 0 else 1.4, zorder=3)  # fmt: skip
        text = (adaptation or classifier) if len(classifiers) == 1 else method
        ends.append(End(text, float(x[-1]), float(rows["value"].iloc[-1]), colour))
    return ends
