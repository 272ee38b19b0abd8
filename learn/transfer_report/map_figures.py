"""Comparisons of transfer in rows and columns: inputs, scenarios, and amplitudes by order."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from learn.transfer_report.curve_figures import FROM_SCRATCH, parts_of, require_rows
from learn.transfer_report.line_ends import GREY
from swgsim.common import style

GAIN, LOSS = "#0072B2", "#D55E00"
WITH, WITHOUT = "#0072B2", "#E69F00"
ORDERS = range(13)


def inputs(errors: pd.DataFrame) -> Figure:
    """Error of every input, with and without the efficiency; one panel per method.

    Parameters
    ----------
    errors : DataFrame
        Columns input, method, efficiency (bool), error [%]; what was not run may be missing.

    Raises
    ------
    ValueError
        If no row has an error.
    """
    known = require_rows(errors, "error")
    names, methods = (list(dict.fromkeys(errors[column])) for column in ("input", "method"))
    picture = style.figure(1.4 + 3.3 * len(methods), 1.7 + 0.55 * len(names))
    panels = picture.subplots(1, len(methods), sharex=True, sharey=True, squeeze=False)[0]
    for axes, method in zip(panels, methods, strict=True):
        of_method = known[known["method"] == method]
        table = of_method.pivot_table(index="input", columns="efficiency", values="error")
        table = table.reindex(index=names, columns=[True, False])
        _input_rows(axes, table)
        style.label(axes, "error [%]", "", str(method))
    # Numbers stand beside the outer dots and need room there.
    low, high = known["error"].min(), known["error"].max()
    room = 0.2 * max(high - low, 1)
    panels[0].set_xlim(low - room, high + room)
    panels[0].set_yticks(range(len(names)), [style.words(str(name)) for name in names])
    panels[0].set_ylim(len(names) - 0.5, -0.5)
    picture.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=2, fontsize=9)
    return picture


def _input_rows(axes: Axes, table: pd.DataFrame) -> None:
    """Two dots joined in every row, with their numbers outside."""
    rows = np.arange(len(table))
    given, withheld = table[True].to_numpy(), table[False].to_numpy()
    axes.hlines(rows, given, withheld, color="#bbbbbb", linewidth=2, zorder=1)
    axes.plot(withheld, rows, "s", color=WITHOUT, markersize=7.5, label="without efficiency")
    axes.plot(given, rows, "o", color=WITH, markersize=6.5, label="with efficiency")
    for row, (first, second) in enumerate(zip(given, withheld, strict=True)):
        if not np.isfinite([first, second]).any():
            axes.annotate("not run", (0.5, row), xycoords=("axes fraction", "data"), va="center", ha="center",
                          fontsize=8.5, color=GREY)  # fmt: skip
            continue
        for value, other, colour in ((first, second, WITH), (second, first, "#8a5f00")):
            right = value > other or (value == other and colour != WITH)
            if np.isfinite(value):
                axes.annotate(f"{value:.1f}", (value, row), xytext=(7 if right else -7, 0), va="center",
                              textcoords="offset points", ha="left" if right else "right", fontsize=9,
                              color=colour)  # fmt: skip


def pays(scenarios: pd.DataFrame) -> Figure:
    """Error without and with adaptation in every scenario, with the error from scratch beside them.

    Parameters
    ----------
    scenarios : DataFrame
        Columns scenario, method, shots, unadapted, error [%]. Methods that end with "from scratch" are drawn as a third
        mark in the rows of the same scenario, classifier and shots.

    Raises
    ------
    ValueError
        If no row has an error.
    """
    rows = beside_from_scratch(require_rows(scenarios, "error"))
    first = ~rows["scenario"].duplicated().to_numpy()
    y = np.arange(len(rows)) + 1.2 * np.cumsum(first)
    picture = style.figure(10, 1.6 + 0.24 * (float(y[-1]) + 1))
    picture.set_layout_engine("constrained", w_pad=0.12)
    axes = picture.add_subplot()
    before, after, scratch = (rows[name].to_numpy() for name in ("unadapted", "error", "scratch"))
    axes.hlines(y, before, after, color=np.where(after > before, LOSS, GAIN), linewidth=2.2, zorder=2)
    axes.plot(before, y, "o", color="black", mfc="white", markersize=6, label="without adaptation", zorder=3)
    marks = (
        ("<", GAIN, after < before, "adapted, better"),
        (">", LOSS, after > before, "adapted, worse"),
        ("D", "#444444", np.isfinite(after) & ~(after < before) & ~(after > before), "adapted, no difference"),
    )
    for marker, colour, which, text in marks:
        if which.any():
            axes.plot(after[which], y[which], marker, color=colour, markersize=7, label=text, zorder=4)
    if np.isfinite(scratch).any():
        axes.plot(scratch, y, "x", color="#777777", markersize=6.5, markeredgewidth=1.8, label=FROM_SCRATCH, zorder=3)
    for column, difference in ((44, after - before), (108, after - scratch)):
        for height, value in zip(y, difference, strict=True):
            if np.isfinite(value):
                text = f"{value:+.1f}".replace("-", "\N{MINUS SIGN}")
                axes.annotate(
                    text, (1, height), xytext=(column, 0), xycoords=("axes fraction", "data"), va="center", ha="right",
                    textcoords="offset points", fontsize=9, color=LOSS if value > 0 else GAIN,
                )  # fmt: skip
    heads = y[first] - 1
    for column, text in ((44, "points to\nunadapted"), (108, "points to\nfrom scratch")):
        axes.annotate(
            text, (1, 1), xytext=(column, 3), xycoords="axes fraction", textcoords="offset points", ha="right",
            va="bottom", fontsize=8.5,
        )  # fmt: skip
    axes.set_yticks(y, rows["text"])
    for head, scenario in zip(heads, rows.loc[first, "scenario"], strict=True):
        axes.annotate(scenario, (0.012, head), xycoords=("axes fraction", "data"), va="center", fontweight="bold")
    for head in heads[1:]:
        axes.axhline(head - 0.65, color="#999999", linewidth=0.8)
    axes.set_ylim(float(y[-1]) + 0.7, -0.5)
    style.label(axes, "error [%]", "")
    picture.legend(loc="outside upper center", ncols=4, fontsize=9)
    return picture


def beside_from_scratch(scenarios: pd.DataFrame) -> pd.DataFrame:
    """One row per adaptation with the error from scratch as a column.

    From scratch has a row of its own where no adaptation has the same classifier and shots.

    Returns
    -------
    DataFrame
        Columns scenario, text, unadapted, error, scratch; scenarios in their order of appearance.
    """
    parts = [parts_of(method) for method in scenarios["method"]]
    split = scenarios.assign(classifier=[part[0] for part in parts], adaptation=[part[1] for part in parts])
    is_scratch = split["adaptation"] == FROM_SCRATCH
    same = ["scenario", "classifier", "shots"]
    scratch = split[is_scratch].rename(columns={"error": "scratch"})[[*same, "scratch"]]
    joined = split[~is_scratch].merge(scratch, on=same, how="outer", sort=False)
    joined["method"] = joined["method"].fillna(joined["classifier"] + f": {FROM_SCRATCH}")
    joined["text"] = joined["method"] + ", K = " + joined["shots"].map("{:g}".format)
    order = {name: place for place, name in enumerate(dict.fromkeys(scenarios["scenario"]))}
    ranks = joined.assign(rank=joined["scenario"].map(order)).sort_values(["rank", "method", "shots"], kind="stable")
    return ranks[["scenario", "text", "unadapted", "error", "scratch"]].reset_index(drop=True)


def spectrum(residuals: pd.DataFrame) -> Figure:
    """Amplitude by order: classes as dots, what is not a class (the disturbance) as bars behind them.

    Parameters
    ----------
    residuals : DataFrame
        Columns source, order, amplitude [mV/V]; an amplitude of 0 is left out, the axis being logarithmic.

    Raises
    ------
    ValueError
        If no amplitude up to order 12 is above 0.
    """
    wanted = residuals["order"].isin(ORDERS) & (residuals["amplitude"] > 0)
    known = require_rows(residuals.assign(amplitude=residuals["amplitude"].where(wanted)), "amplitude")
    floor = 10 ** np.floor(np.log10(known["amplitude"].min()) - 0.1)
    sources = list(dict.fromkeys(known["source"]))
    classes = [source for source in sources if source.replace(" ", "_") in style.CLASS_COLOURS]
    others = [source for source in sources if source not in classes]
    picture = style.figure(11, 5)
    axes = picture.add_subplot()
    for order in ORDERS[::2]:
        axes.axvspan(order - 0.5, order + 0.5, color="#eef4fa", linewidth=0, zorder=0)
    for place, source in enumerate(others):
        of = known[known["source"] == source]
        width = 0.84 / len(others)
        x = of["order"] + width * (place - (len(others) - 1) / 2)
        shade = f"{0.65 + 0.15 * place / len(others):.2f}"
        axes.bar(x, of["amplitude"] - floor, width, bottom=floor, color=shade, label=style.words(source), zorder=1)
    for place, source in enumerate(classes):
        of = known[known["source"] == source]
        x = of["order"] + 0.66 * (place - (len(classes) - 1) / 2) / max(len(classes), 1)
        colour = style.CLASS_COLOURS[source.replace(" ", "_")]
        axes.vlines(x, floor, of["amplitude"], color=colour, linewidth=1.3, zorder=3)
        axes.plot(x, of["amplitude"], "o", color=colour, markersize=5, label=style.words(source), zorder=4)
    axes.set(yscale="log", xlim=(-0.6, 12.6), xticks=ORDERS, ylim=(floor, 2 * known["amplitude"].max()))
    style.label(axes, "order of the wave generator [-]; even orders shaded", "mean amplitude [mV/V]")
    picture.legend(loc="outside upper center", ncols=4, fontsize=9)
    return picture
