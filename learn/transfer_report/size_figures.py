"""Accuracy against the size of a model, on gears of the training and on a gear never seen."""

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from learn.transfer_report.curve_figures import require_rows
from learn.transfer_report.line_ends import GREY, End, name_ends
from swgsim.common import style


def against_size(sizes: pd.DataFrame) -> Figure:
    """Accuracy on the same and on an unseen gear above, the gap between them below; one column per classifier.

    Parameters
    ----------
    sizes : DataFrame
        Columns classifier, setting, size, same, unseen [%]; settings are coloured in their order.

    Raises
    ------
    ValueError
        If no row has a size.
    """
    groups = list(require_rows(sizes, "size").groupby("classifier", sort=False))
    picture = style.figure(5.6 * len(groups), 7)
    picture.set_layout_engine("constrained", w_pad=0.12)
    panels = picture.subplots(2, len(groups), sharex="col", sharey="row", squeeze=False, height_ratios=(3, 2))
    drawn = [_settings(panels[0, column], panels[1, column], of) for column, (_, of) in enumerate(groups)]
    for column, ((classifier, of), (accuracies, gaps)) in enumerate(zip(groups, drawn, strict=True)):
        upper, lower = panels[:, column]
        lower.set_xscale("log")
        ticks = np.unique(of["size"])
        lower.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        lower.set_xticks([], minor=True)
        style.label(upper, "", "accuracy [%]" if column == 0 else "", str(classifier))
        style.label(lower, "size (trees or neurons)", "gap [points]" if column == 0 else "")
        lower.axhline(0, color=GREY, linewidth=0.9)
        for axes, ends in ((upper, accuracies), (lower, gaps)):
            axes.autoscale_view()
            name_ends(axes, ends)
    picture.legend(*_in_black(panels[0, 0]), loc="outside upper center", ncols=2, fontsize=9)
    return picture


def _settings(upper: Axes, lower: Axes, sizes: pd.DataFrame) -> tuple[list[End], list[End]]:
    """Draw one line per setting into both panels; the ends of the lines of the unseen gear and of the gap."""
    settings = list(dict.fromkeys(sizes["setting"]))
    accuracies: list[End] = []
    gaps: list[End] = []
    for setting, shade in zip(settings, np.linspace(0, 0.82, len(settings)), strict=True):
        rows = sizes[sizes["setting"] == setting].sort_values("size")
        colour = to_hex(colormaps["viridis"](shade))
        gap = rows["same"] - rows["unseen"]
        upper.plot(rows["size"], rows["same"], "o--", color=colour, markerfacecolor="white", markersize=4.5)
        upper.plot(rows["size"], rows["unseen"], "o-", color=colour, markersize=4.5)
        lower.plot(rows["size"], gap, "o-", color=colour, markersize=4.5)
        for values, ends in ((rows["unseen"], accuracies), (gap, gaps)):
            if values.notna().any():
                last = values.last_valid_index()
                ends.append(End(str(setting), float(rows.loc[last, "size"]), float(values[last]), colour))
    return accuracies, gaps


def _in_black(axes: Axes) -> tuple[list, list[str]]:
    """Legend of the two kinds of line, whatever the setting."""
    from matplotlib.lines import Line2D

    same = Line2D([], [], color="black", linestyle="--", marker="o", markerfacecolor="white", markersize=4.5)
    unseen = Line2D([], [], color="black", marker="o", markersize=4.5)
    return [same, unseen], ["same gears", "an unseen gear"]
