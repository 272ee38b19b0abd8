"""Pictures of tables as colours: what carries which class, and where recognition is weak."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from swgsim.common import style


def importance_map(importance: pd.DataFrame) -> style.Picture:
    """Drop of recall per group and class, from :func:`learn.evaluation.importance.grouped_permutation`."""
    return style.Picture(
        "Which features carry which class",
        "Points of recall that a class loses when the features of one row are exchanged between recordings of the same "
        "operating point. Look along a column for what a fault is recognised by; an empty column means that several "
        "groups know the same or that none is used.",
        _importance(importance),
    )


def line_map(importance: pd.DataFrame) -> style.Picture:
    """The same of single lines: patterns of gauges and order."""
    return style.Picture(
        "Which gauges and orders carry which class",
        "Points of recall that a class loses when one line says nothing; the number in brackets is the order of the "
        "wave generator's speed. mean is the common part of s1 to s4, wave n what goes n times around the "
        "circumference of the flex spline. Only the lines that cost some class most are shown; look "
        "for the order of the fault's physics, and mind that what two lines know both, neither loses.",
        _importance(importance),
    )


def _importance(importance: pd.DataFrame) -> bytes:
    """Groups in rows, in the order of the table, and classes in columns."""
    drops = importance.pivot(index="group", columns="label", values="drop")
    drops = drops.loc[importance["group"].unique(), [label for label in style.CLASS_COLOURS if label in drops]]
    picture = style.figure(8.4, 0.42 * len(drops) + 1.6)
    _heat(picture.add_subplot(), drops, "drop of recall [points]", 0, max(float(drops.max().max()), 1.0))
    return style.png(picture)


def cell_recall(recall: pd.DataFrame) -> style.Picture:
    """Share recognised per operating point and class, from :func:`learn.evaluation.detection.recall_by_cell`."""
    rows = [f"{speed:g} rpm, {load:g} N m" for speed, load in recall.index]
    picture = style.figure(8.4, 0.42 * len(recall) + 1.6)
    axes = picture.add_subplot()
    _heat(axes, recall.set_axis(rows, axis=0), "recognised [%]", min(50.0, float(recall.min().min())), 100.0)
    row, column = divmod(int(np.nanargmin(recall.to_numpy())), recall.shape[1])
    axes.add_patch(Rectangle((column - 0.48, row - 0.46), 0.96, 0.92, fill=False, edgecolor="#D55E00", linewidth=2.5))
    return style.Picture(
        "Where recognition is weak",
        f"Share of recordings recognised at every operating point. Look at the framed cell, the worst: "
        f"{style.words(str(recall.columns[column]))} at {rows[row]} with "
        f"{float(recall.to_numpy()[row, column]):.1f} %; averages hide it.",
        style.png(picture),
    )


def _heat(axes: Axes, values: pd.DataFrame, name: str, low: float, high: float) -> None:
    """A table as colours with its numbers in the cells."""
    drawn = axes.imshow(values.to_numpy(), cmap="cividis", vmin=low, vmax=high, aspect="auto")
    for (row, column), value in np.ndenumerate(values.to_numpy()):
        colour = "black" if value > low + 0.6 * (high - low) else "white"
        # + 0.0: no minus zero.
        axes.text(column, row, f"{round(value, 1) + 0.0:.1f}", ha="center", va="center", color=colour)
    axes.set_yticks(range(len(values)), list(values.index))
    axes.set_xticks(range(values.shape[1]), [style.words(str(label)).replace(" ", "\n") for label in values])
    axes.figure.colorbar(drawn, ax=axes, label=name)
