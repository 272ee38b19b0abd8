"""Pictures of the study: cells before and after, and which choice moves what."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from learn.paper.paper_page import ROMAN
from learn.paper_choices.choice import Choice
from learn.paper_choices.evaluation import FITTED, Tables
from swgsim.common import style

COLOURS = {"mlp": "#56B4E9", "svm": "#D55E00", "rf": "#009E73", "knn": "#E69F00", "nb": "#000000"}


def before_and_after(before: Tables, after: Tables) -> Figure:
    """Our score over the paper's for every cell of the four tables, with the values of grid=paper and those found."""
    picture = style.figure(12, 6.6)
    panels = picture.subplots(2, 4, sharex=True, sharey=True)
    for row, (name, tables) in zip(panels, {"before": before, "after": after}.items(), strict=True):
        for axes, (table, comparison) in zip(row, tables.items(), strict=True):
            axes.plot([20, 100], [20, 100], color="#999999", linewidth=0.8)
            for classifier, cells in comparison.figures.groupby("classifier"):
                key = str(classifier)
                axes.plot(cells["paper"], cells["ours"], "o", color=COLOURS[key], markersize=4.5, label=key.upper())
            role = "fitted" if table in FITTED else "not seen by this fit"
            error = f"{comparison.mean_absolute_difference:.1f} points"
            style.label(axes, "", "", f"Table {ROMAN[table]} ({role})\n{name}: {error}")
        row[0].set_ylabel("our score [%]")
    for axes in panels[1]:
        axes.set_xlabel("the paper's score [%]")
    picture.legend(*panels[0, 0].get_legend_handles_labels(), ncols=5, loc="outside upper center")
    return picture


def effects(slopes: pd.DataFrame, choices: Sequence[Choice]) -> Figure:
    """Change of the scores for one standard deviation of each choice, means over the gears of a row group."""
    level = ["table", "features", "classifier"]
    tested = slopes[slopes.index.get_level_values("row") != "train"]
    means = tested.groupby(level, sort=False).mean().dropna()
    largest = float(np.abs(means.to_numpy()).max())
    picture = style.figure(12.5, 0.34 * len(choices) + 2.6)
    axes = picture.add_subplot()
    drawn = axes.imshow(means.T, cmap="RdBu_r", vmin=-largest, vmax=largest, aspect="auto")
    axes.set_yticks(range(len(choices)), [each.name.replace("_", " ") for each in choices])
    axes.set_xticks(
        range(len(means)), [f"{key[2].upper()} S{key[1][-1]}" for key in means.index], rotation=90, fontsize=8
    )
    tables = means.index.get_level_values("table")
    for table in tables.unique():
        where = np.flatnonzero(tables == table)
        axes.text(where.mean(), -0.9, f"Table {ROMAN[table]}", ha="center", fontsize=10)
        axes.axvline(where[-1] + 0.5, color="black", linewidth=1)
    picture.colorbar(drawn, ax=axes, label="points per standard deviation of the prior")
    return picture
