"""Figure of the study: accuracy on unseen gears and on disturbed recordings against flash and instructions."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from learn.embedded.trade import Part
from swgsim.common import style

COLOURS = ("#000000", "#0072B2", "#E69F00", "#56B4E9", "#D55E00", "#009E73", "#CC79A7", "#7F7F7F")
MARKERS = {"float": "o", "int16": "s", "int8": "^"}
COSTS = {"flash": "flash [kB]", "instructions": "instructions per decision [10³]"}
UNITS = {"flash": 1024.0, "instructions": 1000.0}
ACCURACIES = {"unseen": "unseen gears [%]", "disturbed": "disturbed recordings [%]"}
GREY = "#888888"
BESIDE = ((4, 4), (4, -11), (-13, 4), (-13, -11))  # a marker, in turn, for numbers of neighbours not to overlap [pt]


def drawn(variants: pd.DataFrame, part: Part) -> Figure:
    """One marker per variant, numbered as in the legend; variants right of a dashed line do not fit the part.

    Parameters
    ----------
    variants : DataFrame
        Of :func:`learn.embedded.table.variants_of`, with flash and instructions.
    part : Part
    """
    picture = style.figure(12, 7.5)
    limits = {"flash": float(part.flash), "instructions": part.instructions / part.rate}
    panels = picture.subplots(len(ACCURACIES), len(COSTS), sharex="col", sharey="row")
    for row, (accuracy, title) in enumerate(ACCURACIES.items()):
        for column, cost in enumerate(COSTS):
            axes = panels[row, column]
            _points(axes, variants, accuracy, cost)
            axes.axvline(limits[cost] / UNITS[cost], color=GREY, linestyle="--", linewidth=1)
            axes.set_xscale("log")
            axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axes.xaxis.set_major_formatter("{x:g}")
            axes.xaxis.set_minor_formatter(NullFormatter())
            style.label(axes, COSTS[cost] if row else "", "" if column else title)
    picture.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside right center", fontsize=8, frameon=False)
    return picture


def _points(axes: Axes, variants: pd.DataFrame, accuracy: str, cost: str) -> None:
    methods = list(dict.fromkeys(name.rpartition(", ")[0] for name in variants.index))
    for number, (name, row) in enumerate(variants.iterrows(), start=1):
        method, _, numbers = str(name).rpartition(", ")
        colour = COLOURS[methods.index(method) % len(COLOURS)]
        x = row[cost] / UNITS[cost]
        if accuracy == "unseen":
            axes.vlines(x, row["low"], row["high"], color=colour, linewidth=0.8, alpha=0.6)
        axes.plot(x, row[accuracy], MARKERS[numbers], color=colour, markersize=5, label=f"{number}  {name}")
        place = BESIDE[number % len(BESIDE)]
        axes.annotate(str(number), (x, row[accuracy]), place, textcoords="offset points", fontsize=8, color=colour)
