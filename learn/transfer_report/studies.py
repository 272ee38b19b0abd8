"""The studies beside the main comparison as tables: disturbed data, inputs, where transfer pays, splits, and size."""

from collections.abc import Mapping

import pandas as pd

from learn.bootstrap import specimens
from learn.evaluation import metric_key
from learn.paper import paper_table
from learn.transfer_report.results import difference, row_of, with_intervals
from learn.transfer_report.runs import CLASSIFIERS, by_method, method_of, paired
from swgsim.style import words

PAPER_FOREST = "random forest on Selection 3"  # the paper's best in Table X
INPUTS: Mapping[str, str] = {
    "raw": "raw",
    "differenced": "differenced",
    "selection_all": "features",
    "residual": "residual",
}
NETWORKS: Mapping[str, str] = {"perceptron": "mlp", "cnn": "cnn", "minirocket": "minirocket"}
# Size, along the axis, and what tells lines apart, of the paper's two classifiers whose robustness it asks about.
SIZES: Mapping[str, tuple[str, str]] = {
    "rf": ("classifier.trees", "classifier.depth"),
    "mlp": ("classifier.neurons", "classifier.hidden_layers"),
}
WITHOUT_EFFICIENCY = ("False", "none")
TARGETS: Mapping[str, str] = {
    "None": "other gears of the sources' population",
    "few-bench": "other gears of the sources' population",
    "far-bench": "gears far outside the sources",
    "few-noisy": "another noise",
    "few-other_day": "a reference from another day",
}
SCENARIO = ["target", "protocol.sources", "features.acquisitions"]


def disturbed_cases(runs: pd.DataFrame) -> pd.DataFrame:
    """Accuracy of every method (rows) in the three cases of Table X (columns), and of the paper's forest [%].

    Raises
    ------
    ValueError
        If the paper's forest was not run.
    """
    paper = paper_table("table10").query("classifier == 'rf' and features == 'selection_3'")
    cases = list(paper["row"])
    ours = by_method(runs)[[f"test/{metric_key(case)}" for case in cases]].set_axis(cases, axis="columns")
    if PAPER_FOREST not in ours.index:
        raise ValueError(f"no run of the {PAPER_FOREST} on the disturbed data: add classifier=rf features=selection_3")
    theirs = pd.DataFrame([paper["paper"].to_numpy()], index=["the paper's own figures"], columns=cases)
    return pd.concat([theirs, ours.astype(float)])


def best_disturbed(cases: pd.DataFrame) -> str:
    """Our method with the highest accuracy in its worst case."""
    return str(cases.iloc[1:].min(axis="columns").idxmax())


def inputs(runs: pd.DataFrame, predictions: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Error of networks on different inputs.

    Parameters
    ----------
    runs : DataFrame
        Of the study ``inputs``.
    predictions : mapping
        Index of a run to its table of predictions.

    Returns
    -------
    DataFrame
        ``input``, ``method``, ``efficiency`` and ``error``, ``low``, ``high`` [%].
    """
    facts = pd.DataFrame(
        {
            "input": runs["features"].map(INPUTS),
            "method": runs["classifier"].map(NETWORKS),
            "efficiency": ~runs["features.efficiency"].isin(WITHOUT_EFFICIENCY),
        },
    ).set_axis(runs.index.astype(str))
    facts = facts.drop_duplicates().dropna()
    errors = with_intervals({key: specimens(predictions[key]) for key in facts.index}, "inputs")
    return facts.join(errors).rename(columns={"value": "error"}).reset_index(drop=True)


def nested_inputs(table: pd.DataFrame, *, efficiency: bool) -> dict[str, dict[str, float | None]]:
    """Input to method to error [%], as the JSON has it; None where nothing was run."""
    chosen = table[table["efficiency"] == efficiency].set_index(["input", "method"])["error"]
    return {
        kind: {m: round(float(chosen[kind, m]), 3) if (kind, m) in chosen.index else None for m in NETWORKS.values()}
        for kind in INPUTS.values()
    }


def networks_compared(runs: pd.DataFrame, predictions: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Error of the CNN and of MiniRocket minus that of the MLP on the same input, with efficiency, paired.

    Returns
    -------
    DataFrame
        Index ``CNN on raw signals`` and so on; ``value``, ``low``, ``high`` [points].
    """
    given = runs[~runs["features.efficiency"].isin(WITHOUT_EFFICIENCY)].rename(index=str).rename_axis("key")
    named = by_method(given.reset_index())
    rows: dict[str, pd.Series] = {}
    for _, of_input in named.groupby("features"):
        errors = paired({str(name): specimens(predictions[str(key)]) for name, key in of_input["key"].items()})
        simple = [str(name) for name in of_input.index[of_input["classifier"] == "perceptron"]]
        others = [str(name) for name in of_input.index[of_input["classifier"] != "perceptron"]]
        rows |= {method: difference(errors, method, reference) for reference in simple for method in others}
    return pd.DataFrame(rows).T


def scenario_of(run: Mapping[str, object]) -> str:
    """Where a run of the map adapts to and with what, as text.

    >>> scenario_of({"target": "far-bench", "protocol.sources": "26", "features.acquisitions": "1"})
    'gears far outside the sources: 26 source gears, 1 reference acquisition'
    """
    sources, acquisitions = (str(run.get(name, "None")) for name in SCENARIO[1:])
    gears = "all source gears" if sources == "None" else f"{sources} source gears"
    if acquisitions == "None":
        known = "all reference acquisitions"
    else:
        known = f"{acquisitions} reference acquisition{'' if acquisitions == '1' else 's'}"
    target = str(run.get("target", "None"))
    return f"{TARGETS.get(target, target)}: {gears}, {known}"


def transfer_map(runs: pd.DataFrame, adapted: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """What adapting gives in every scenario.

    Parameters
    ----------
    runs : DataFrame
        Of the study ``transfer_map``.
    adapted : mapping
        Index of a run to its table of specimens.

    Returns
    -------
    DataFrame
        ``scenario``, ``method``, ``shots``, ``unadapted`` and ``error`` [%], and the change that the method makes to
        the source model, ``gain``, ``low``, ``high`` [points].
    """
    rows = []
    for key, run in runs.rename(index=str).iterrows():
        facts = {str(name): value for name, value in run.dropna().items()}
        order = [facts.get(name, "None") for name in SCENARIO]
        numbers = [float("inf") if text == "None" else float(str(text)) for text in order[1:]]
        for shots, part in adapted[str(key)].groupby("shots"):
            changed = part.assign(error=part["error"] - part["unadapted"])
            change = row_of(with_intervals({"gain": changed}, "map"), "gain")
            rows.append({
                "scenario": scenario_of(facts), "method": method_of(facts), "shots": int(str(shots)),
                "unadapted": float(part["unadapted"].mean()), "error": float(part["error"].mean()),
                "gain": change["value"], "low": change["low"], "high": change["high"],
                "order": (str(order[0]), *numbers),
            })  # fmt: skip
    table = pd.DataFrame(rows).drop_duplicates(["scenario", "method", "shots"])
    return table.sort_values(["order", "shots", "method"], ignore_index=True).drop(columns="order")


def robustness(runs: pd.DataFrame) -> pd.DataFrame:
    """Accuracy on the same gears and on an unseen one against size.

    Returns
    -------
    DataFrame
        ``classifier``, ``setting`` (text), ``size``, ``same`` and ``unseen`` [%], ``gap`` [points].
    """
    parts = []
    for classifier, of_kind in runs.groupby("classifier"):
        size, setting = SIZES[str(classifier)]
        scores = of_kind.drop_duplicates(["protocol", size, setting])
        scores = scores.pivot(index=[setting, size], columns="protocol", values="test_score").reset_index()
        noun = setting.split(".")[1].replace("_", " ")
        parts.append(
            pd.DataFrame(
                {
                    "classifier": CLASSIFIERS[str(classifier)],
                    "setting": noun + " " + scores[setting],
                    "size": scores[size].astype(int),
                    "same": scores["grouped_folds"].astype(float),
                    "unseen": scores["leave_one_gear_out"].astype(float),
                }
            )
        )
    table = pd.concat(parts, ignore_index=True)
    table["order"] = table["setting"].str.split().str[-1].astype(int)
    table = table.sort_values(["classifier", "order", "size"], ignore_index=True).drop(columns="order")
    return table.assign(gap=table["same"] - table["unseen"])


def harder_splits(runs: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """Per protocol the accuracy of every method (rows) on every split, and their mean (columns) [%]."""
    parts = {}
    for protocol, of_protocol in runs.groupby("protocol"):
        scores = by_method(of_protocol).filter(regex="^test/").astype(float).dropna(axis="columns", how="all")
        scores.columns = [str(name).removeprefix("test/").replace("_", " ") for name in scores]
        parts[words(str(protocol))] = scores.assign(mean=scores.mean(axis="columns"))
    return parts
