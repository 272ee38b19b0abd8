"""Figures of the report as PNG: errors, error against shots, and confidence.

All are narrow, and panels lie below each other, so that they are readable on a phone.
"""

from collections.abc import Mapping
from textwrap import fill

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from learn.evaluation.probability_calibration import expected_calibration_error
from learn.evaluation.selective import coverage_at
from learn.transfer_report.tables import FOREST, FROM_SCRATCH, LIMITS, row_of
from swgsim.common import style

WIDTH = 6.0  # inch
GREY, BLUE, ORANGE = "#777777", "#0072B2", "#D55E00"
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#000000")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")  # one more than colours, so that pairs repeat late
FORESTS = ("random forest", "extra trees")  # begin the names of these methods


def intervals(axes: Axes, table: pd.DataFrame, colours: list[str], heights: np.ndarray) -> None:
    """``value`` of every row with the interval from ``low`` to ``high``."""
    for height, colour, (value, low, high) in zip(
        heights, colours, table[["value", "low", "high"]].to_numpy(dtype=float), strict=True
    ):
        axes.plot([low, high], [height, height], color=colour, linewidth=1.6)
        axes.plot(value, height, "o", color=colour, markersize=5)


def errors(table: pd.DataFrame) -> bytes:
    """Errors of :func:`.tables.zero_shot` with intervals; those who know the gear are lines."""
    methods = table.drop(index=LIMITS, errors="ignore").sort_values("value", ascending=False)
    picture = style.figure(WIDTH, 1.3 + 0.3 * len(methods))
    axes = picture.add_subplot()
    heights = np.arange(len(methods))
    intervals(axes, methods, [ORANGE if name == FOREST else BLUE for name in methods.index], heights)
    for name, dashes in zip(LIMITS, ("-", "--", ":"), strict=True):
        if name not in table.index:
            continue
        axes.axvline(row_of(table, name)["value"], color="black", linewidth=1.1, linestyle=dashes, label=name)
    axes.set_yticks(heights, list(methods.index))
    axes.set_xlim(0, None)
    style.label(axes, "error [%]", "")
    picture.legend(loc="outside upper center", ncols=2)
    return style.png(picture)


def known(table: pd.DataFrame) -> bytes:
    """Errors of :func:`.twins.known` over what is known; full marks for recordings, empty ones for units."""
    levels = list(dict.fromkeys(table["known"]))
    picture = style.figure(WIDTH, 4.6)
    axes = picture.add_subplot()
    middle = (table["who"].nunique() - 1) / 2
    for number, (who, rows) in enumerate(table.groupby("who", sort=False)):
        colour, places = COLOURS[number], [levels.index(each) + 0.12 * (number - middle) for each in rows["known"]]
        for of, face in (("value", colour), ("unit", "white")):
            ends = ("low", "high") if of == "value" else ("unit_low", "unit_high")
            axes.vlines(places, rows[ends[0]], rows[ends[1]], color=colour, linewidth=1.1)
            text = f"{who}, per {'recording' if of == 'value' else 'unit'}"
            axes.plot(places, rows[of], MARKERS[number], color=colour, markerfacecolor=face, label=text)
    axes.set_xticks(range(len(levels)), [fill(each, 13) for each in levels])
    axes.set_xlim(-0.5, len(levels) - 0.5)
    axes.set_ylim(0, None)
    style.label(axes, "known of the gear", "error [%]")
    axes.margins(x=0.12)
    picture.legend(loc="outside lower center", fontsize=9, frameon=False)
    return style.png(picture)


def shots(few: pd.DataFrame, levels: Mapping[str, float]) -> bytes:
    """Errors of :func:`.tables.few_shot` against the number of shots; networks above, forests below.

    Parameters
    ----------
    few : DataFrame
    levels : mapping
        Name to error [%] of methods without labels, which are dashed lines.
    """
    labelled = few[few["shots"] > 0]
    is_forest = labelled["method"].str.startswith(FORESTS)
    groups = [group for group in (labelled[~is_forest], labelled[is_forest]) if len(group)]
    ticks = {int(number): place for place, number in enumerate(sorted(labelled["shots"].unique()))}
    picture = style.figure(WIDTH, 5.3 * len(groups))
    for axes, group in zip(picture.subplots(len(groups), squeeze=False)[:, 0], groups, strict=True):
        methods = list(group["method"].unique())
        for number, name in enumerate(methods):
            rows = group[group["method"] == name].sort_values("shots")
            colour = GREY if name.endswith(FROM_SCRATCH) else COLOURS[number % len(COLOURS)]
            x = rows["shots"].map(ticks).to_numpy() + 0.4 * (number - (len(methods) - 1) / 2) / len(methods)
            axes.vlines(x, rows["low"], rows["high"], color=colour, linewidth=1.1, alpha=0.6)
            axes.plot(x, rows["value"], f"{MARKERS[number % len(MARKERS)]}-", color=colour, markersize=5, label=name)
        for dashes, (name, value) in zip(("--", "-.", ":"), levels.items(), strict=True):
            axes.axhline(value, color="black", linewidth=1.1, linestyle=dashes, label=name)
        axes.set_xticks(list(ticks.values()), [str(number) for number in ticks])
        style.label(axes, "labelled variants of each class, K", "error [%]")
        axes.set_ylim(0, None)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=2, fontsize=9, frameon=False)
    return style.png(picture)


def confidence(bins: Mapping[str, pd.DataFrame], curves: Mapping[str, pd.DataFrame]) -> bytes:
    """Accuracy against confidence above, error against the share of decided recordings below; by method."""
    picture = style.figure(WIDTH, 9.6)
    upper, lower = picture.subplots(2)
    upper.plot([0, 100], [0, 100], color=GREY, linewidth=1, linestyle=":")
    for number, (name, table) in enumerate(bins.items()):
        colour, text = COLOURS[number], f"{name} (calibration error {expected_calibration_error(table):.1f} points)"
        upper.plot(100 * table["confidence"], 100 * table["accuracy"], f"{MARKERS[number]}-", color=colour, label=text)
        text = f"{name} ({100 * coverage_at(curves[name], 0.05):.0f} % decided at 5 % error)"
        coverage, risk = 100 * curves[name]["coverage"], 100 * curves[name]["risk"]
        lower.step(coverage, risk, where="post", color=colour, label=text)
    for error in (1, 5):
        lower.axhline(error, color=GREY, linewidth=0.9, linestyle=":")
    lowest = min(100 * min(table["confidence"].min(), table["accuracy"].min()) for table in bins.values())
    upper.set(xlim=(max(0, lowest - 5), 101), ylim=(max(0, lowest - 5), 102))
    lower.set(xlim=(0, 100), ylim=(0, None))
    style.label(upper, "confidence: highest probability [%]", "accuracy [%]", "Calibration")
    style.label(lower, "share of recordings decided, most confident first [%]", "error among these [%]", "Abstention")
    for axes in (upper, lower):
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), fontsize=9, frameon=False)
    return style.png(picture)
