"""Study of inputs over the number of simulated gears in training: errors there and on gears never seen."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from learn.transfer_report.figures import COLOURS, MARKERS, WIDTH
from learn.transfer_report.runs import CLASSIFIERS
from learn.transfer_report.tables import in_json, number, with_intervals
from swgsim.common import style

INPUTS: Mapping[str, str] = {
    "raw": "raw",
    "template": "raw minus the healthy reference",
    "differenced": "differenced",
    "residual": "residual",
}
NETWORKS: Mapping[str, str] = {"perceptron": "mlp", "cnn": "cnn", "resnet": "resnet", "minirocket": "minirocket"}
GEARS = 100  # of which transfer.json speaks


def over_gears(runs: pd.DataFrame, errors: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Errors of every input, network and number of training gears.

    Parameters
    ----------
    runs : DataFrame
        Runs of the study ``inputs_gears``, newest first.
    errors : mapping
        Index of a run to its errors of specimens.

    Returns
    -------
    DataFrame
        ``input``, ``method``, ``gears``; ``training``, the error on the rows of the training [%]; ``seeds``; and on
        gears never seen ``value``, ``low``, ``high`` [%].
    """
    facts = pd.DataFrame(
        {
            "input": runs["features"],
            "method": runs["classifier"],
            "gears": runs["protocol.sources"].astype(int),
            "training": 100 - runs["train_score"],
            "seeds": runs["seeds"],
        }
    ).set_axis(runs.index.astype(str))
    facts = facts.drop_duplicates(["input", "method", "gears"])
    return facts.join(with_intervals({key: errors[key] for key in facts.index}, "inputs over gears"))


def over_gears_text(table: pd.DataFrame) -> pd.DataFrame:
    """Result of :func:`over_gears`: input and number of gears in rows, networks in columns; the training error last."""
    judged = [number(*row) for row in table[["value", "low", "high"]].to_numpy(dtype=float)]
    text = [f"{error}; {number(training)}" for error, training in zip(judged, table["training"], strict=True)]
    wide = table.assign(text=text).pivot(index=["input", "gears"], columns="method", values="text")
    rows = pd.MultiIndex.from_product([INPUTS, sorted(set(table["gears"]))], names=["input", "gears"])
    wide = wide.reindex(index=rows, columns=list(NETWORKS)).dropna(how="all").rename(columns=CLASSIFIERS).fillna("-")
    return wide.rename(index=INPUTS, level="input").rename(index=str, level="gears").rename_axis(None, axis="columns")


def over_gears_json(table: pd.DataFrame | None) -> dict[str, dict[str, Any]]:
    """Input to network to error [%] with its interval, of about :data:`GEARS` gears; None for what was not run."""
    found: dict[str, dict[str, Any]] = {kind: dict.fromkeys(NETWORKS.values()) for kind in INPUTS}
    if table is not None:
        distance = (table["gears"] - GEARS).abs()
        for _, row in table.loc[distance.groupby([table["input"], table["method"]]).idxmin()].iterrows():
            found[row["input"]][NETWORKS[row["method"]]] = in_json(row) | {"gears": int(row["gears"])}
    return found


def over_gears_figure(table: pd.DataFrame) -> bytes:
    """Errors of :func:`over_gears` over the number of gears, a panel for each network; dashed in training."""
    networks = [name for name in NETWORKS if name in set(table["method"])]
    picture = style.figure(WIDTH, 0.8 + 2.5 * len(networks))
    panels = picture.subplots(len(networks), sharex=True, sharey=True, squeeze=False)[:, 0]
    highest = float(np.nanmax(table[["value", "high", "training"]].to_numpy(dtype=float)))
    for axes, name in zip(panels, networks, strict=True):
        for place, (kind, text) in enumerate(INPUTS.items()):
            rows = table[(table["method"] == name) & (table["input"] == kind)].sort_values("gears")
            look = {"color": COLOURS[place], "marker": MARKERS[place], "markersize": 5}
            axes.vlines(rows["gears"], rows["low"], rows["high"], color=COLOURS[place], linewidth=1.1)
            axes.plot(rows["gears"], rows["value"], label=text, **look)
            axes.plot(rows["gears"], rows["training"], linestyle="--", markerfacecolor="white", **look)
        axes.set_xscale("log")
        axes.set_ylim(0, 1.08 * highest)
        style.label(axes, "", "error [%]", CLASSIFIERS[name])
    gears = sorted(set(table["gears"]))
    panels[-1].set_xticks(gears, [str(each) for each in gears], minor=False)
    panels[-1].minorticks_off()
    panels[-1].set_xlabel("simulated gears in training")
    picture.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return style.png(picture)
