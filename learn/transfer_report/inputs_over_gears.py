"""Study of inputs over the number of simulated gears in training: errors there and on gears never seen."""

from collections import Counter
from collections.abc import Hashable, Mapping
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
    "residual_with_reference": "residual and reference",
}
NETWORKS: Mapping[str, str] = {"perceptron": "mlp", "cnn": "cnn", "resnet": "resnet", "minirocket": "minirocket"}
GEARS = 100  # of which transfer.json speaks
OPTION = r"^(classifier|features|protocol)\.|^training$"  # names of the options of a run


def over_gears(runs: pd.DataFrame, errors: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Errors of every input, network and number of training gears, runs with other options apart.

    Parameters
    ----------
    runs : DataFrame
        Runs of the study ``inputs_gears``, newest first, one for all its seeds (:func:`.seeds.averaged`). Those of
        inputs and networks other than :data:`INPUTS` and :data:`NETWORKS` are left out.
    errors : mapping
        Index of a run to its errors of specimens.

    Returns
    -------
    DataFrame
        ``input``, ``method``, ``gears``, ``options`` (:func:`unusual_options`); ``training``, the error on the rows of
        the training [%]; ``seeds``; and on gears never seen ``value``, ``low``, ``high`` [%].
    """
    runs = runs[runs["features"].isin(list(INPUTS)) & runs["classifier"].isin(list(NETWORKS))]
    facts = pd.DataFrame(
        {
            "input": runs["features"],
            "method": runs["classifier"],
            "gears": runs["protocol.sources"].astype(int),
            "options": unusual_options(runs),
            "training": 100 - runs["train_score"],
            "seeds": runs["seeds"],
        }
    ).set_axis(runs.index.astype(str))
    facts = facts.drop_duplicates(["input", "method", "gears", "options"])
    # One by one, as runs with other options may be judged on other recordings.
    return facts.join(pd.concat([with_intervals({key: errors[key]}, "inputs over gears") for key in facts.index]))


def unusual_options(runs: pd.DataFrame) -> pd.Series:
    """Options of every run that most runs of the same network and number of gears have otherwise; often none.

    Of values that equally many runs have, that of the newest is usual. An option that a run does not know is left out.
    """
    options = runs.filter(regex=OPTION)
    said: dict[Hashable, str] = {}
    for _, rows in options.groupby([runs["classifier"], runs["protocol.sources"]]):
        usual = {name: Counter(rows[name].dropna()).most_common(1) for name in rows}
        for key, run in rows.iterrows():
            known = run.dropna()
            said[key] = ", ".join(f"{name}={value}" for name, value in known.items() if value != usual[name][0][0])
    return pd.Series(said, dtype=object).reindex(runs.index)


def over_gears_text(table: pd.DataFrame) -> pd.DataFrame:
    """Result of :func:`over_gears`: input, options and number of gears in rows, networks in columns.

    The training error comes last.
    """
    judged = [number(*row) for row in table[["value", "low", "high"]].to_numpy(dtype=float)]
    text = [f"{error}; {number(training)}" for error, training in zip(judged, table["training"], strict=True)]
    cells = table.assign(text=text, input=pd.Categorical(table["input"], list(INPUTS), ordered=True))
    wide = cells.pivot(index=["input", "options", "gears"], columns="method", values="text").sort_index()
    names = [(f"{INPUTS[kind]}, {options}".removesuffix(", "), str(gears)) for kind, options, gears in wide.index]
    wide = wide.reindex(columns=list(NETWORKS)).rename(columns=CLASSIFIERS).rename_axis(None, axis="columns")
    return wide.fillna("-").set_axis(pd.MultiIndex.from_tuples(names, names=["input", "gears"]))


def over_gears_json(table: pd.DataFrame | None) -> dict[str, dict[str, Any]]:
    """Input to network to error [%] with its interval, of about :data:`GEARS` gears; None for what was not run."""
    found: dict[str, dict[str, Any]] = {kind: dict.fromkeys(NETWORKS.values()) for kind in INPUTS}
    if table is not None:
        usual = table[table["options"] == ""]
        distance = (usual["gears"] - GEARS).abs()
        for _, row in usual.loc[distance.groupby([usual["input"], usual["method"]]).idxmin()].iterrows():
            found[row["input"]][NETWORKS[row["method"]]] = in_json(row) | {"gears": int(row["gears"])}
    return found


def over_gears_figure(table: pd.DataFrame) -> bytes:
    """Errors of :func:`over_gears` with usual options over the number of gears, a panel for each network.

    The training error is dashed.
    """
    table = table[table["options"] == ""]
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
