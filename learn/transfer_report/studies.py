"""Tables of the further studies: inputs, where transfer pays, and the paper's disturbed data."""

from collections.abc import Mapping
from typing import cast

import numpy as np
import pandas as pd

from learn.evaluation.evaluate import metric_key
from learn.paper.published_tables import paper_table
from learn.transfer_report.runs import CLASSIFIERS, by_method
from learn.transfer_report.tables import FROM_SCRATCH, difference, number, paired, text_of, with_intervals

DISTURBED_FOREST = "random forest on Selection 3"  # the paper's best in Table X
PUBLISHED = "the paper's own figures"
INPUTS: Mapping[str, str] = {
    "raw": "raw",
    "differenced": "differenced",
    "selection_all": "features",
    "residual": "residual",
}
NETWORKS: Mapping[str, str] = {"perceptron": "mlp", "cnn": "cnn", "minirocket": "minirocket"}
GIVEN, WITHHELD = "with the operating point", "without"  # these texts seed the bootstrap
SCENARIO = ["target", "protocol.sources", "features.acquisitions"]
TARGETS: Mapping[str, str] = {
    "None": "other gears of the sources' population",
    "few-bench": "other gears of the sources' population",
    "far-bench": "gears far outside the sources",
    "few-noisy": "another noise",
    "few-other_day": "a reference from another day",
}


def inputs(runs: pd.DataFrame, errors: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Error of networks on different inputs: ``input``, ``method``, ``efficiency``, ``value``, ``low``, ``high`` [%].

    Parameters
    ----------
    runs : DataFrame
        Runs of the study ``inputs``.
    errors : mapping
        Index of a run to its errors of specimens.
    """
    facts = pd.DataFrame(
        {
            "input": runs["features"].map(INPUTS),
            "method": runs["classifier"].map(NETWORKS),
            "efficiency": with_efficiency(runs),
        },
    ).set_axis(runs.index.astype(str))
    facts = facts.drop_duplicates().dropna()
    found = with_intervals({key: errors[key] for key in facts.index}, "inputs")
    return facts.join(found).reset_index(drop=True)


def with_efficiency(runs: pd.DataFrame) -> pd.Series:
    """Which runs have the efficiency among their inputs."""
    return ~runs["features.efficiency"].isin(("False", "none"))


def inputs_text(table: pd.DataFrame) -> pd.DataFrame:
    """Result of :func:`inputs`: input and efficiency in rows, networks in columns."""
    cells = table.assign(text=text_of(table), efficiency=table["efficiency"].map({True: "with", False: "without"}))
    wide = cells.pivot(index=["input", "efficiency"], columns="method", values="text")
    rows = pd.MultiIndex.from_product([INPUTS.values(), ["with", "without"]], names=["input", "efficiency"])
    names = {short: CLASSIFIERS[name] for name, short in NETWORKS.items()}
    return wide.reindex(index=rows, columns=list(names)).rename(columns=names).fillna("-")


def nested_inputs(table: pd.DataFrame, *, efficiency: bool) -> dict[str, dict[str, float | None]]:
    """Input to method to error [%], as in ``transfer.json``; None for what was not run."""
    chosen = table[table["efficiency"] == efficiency].set_index(["input", "method"])["value"]
    return {
        kind: {m: round(float(chosen[kind, m]), 3) if (kind, m) in chosen.index else None for m in NETWORKS.values()}
        for kind in INPUTS.values()
    }


def without_text(runs: pd.DataFrame, bare: pd.DataFrame, errors: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Error of every method with and without some of its inputs; the difference is paired.

    Parameters
    ----------
    runs, bare : DataFrame
        Runs with all inputs and runs without some of them; the same methods, with indices that differ.
    errors : mapping
        Index of a run of either to its errors of specimens.
    """
    given, withheld = by_method(runs)["key"], by_method(bare)["key"]
    rows = {}
    for method in given.index.intersection(withheld.index):
        both = paired({GIVEN: errors[given[method]], WITHHELD: errors[withheld[method]]})
        change = difference(both, WITHHELD, GIVEN)
        rows[method] = [number(both[GIVEN].mean()), number(both[WITHHELD].mean()), number(*change)]
    columns = ["with [%]", "without [%]", "difference [points]"]
    return pd.DataFrame(rows, index=columns).T.rename_axis("method")


def scenario_of(run: Mapping[str, object]) -> str:
    """Target, source gears and references of a run of the map.

    >>> scenario_of({"target": "far-bench", "protocol.sources": "26", "features.acquisitions": "1"})
    'gears far outside the sources: 26 source gears, 1 reference acquisition'
    """
    target, sources, acquisitions = (str(run.get(name, "None")) for name in SCENARIO)
    gears = "all source gears" if sources == "None" else f"{sources} source gears"
    known = "all reference acquisitions" if acquisitions == "None" else f"{acquisitions} reference acquisition"
    return f"{TARGETS.get(target, target)}: {gears}, {known}{'' if acquisitions in ('None', '1') else 's'}"


def best_unadapted(runs: pd.DataFrame, errors: Mapping[str, pd.DataFrame]) -> dict[str, tuple[str, pd.DataFrame]]:
    """Best method without adaptation of every scenario: its name with the number of methods, and its specimens.

    It is chosen on the judged gears, which flatters this method and never the adapted ones.

    Parameters
    ----------
    runs : DataFrame
        Runs of the study ``transfer_map`` with ``adaptation=none``, newest first.
    errors : mapping
        Index of a run to its errors of specimens.
    """
    best = {}
    for scenario, here in runs.assign(scenario=_scenarios(runs)).groupby("scenario"):
        methods = {name: errors[str(key)] for key, name in here.drop_duplicates("method")["method"].items()}
        name = min(methods, key=lambda method: methods[method]["error"].mean())
        best[str(scenario)] = (f"{name} (of {len(methods)})", methods[name])
    return best


def _scenarios(runs: pd.DataFrame) -> list[str]:
    return [scenario_of({str(name): value for name, value in run.dropna().items()}) for _, run in runs.iterrows()]


def transfer_map(
    runs: pd.DataFrame, adapted: Mapping[str, pd.DataFrame], unadapted: Mapping[str, tuple[str, pd.DataFrame]]
) -> pd.DataFrame:
    """Change of the error by adapting in every scenario.

    Parameters
    ----------
    runs : DataFrame
        Runs of the study ``transfer_map`` that adapt.
    adapted : mapping
        Index of a run to its table of specimens.
    unadapted : mapping
        Result of :func:`best_unadapted`.

    Returns
    -------
    DataFrame
        ``scenario``, ``method``, ``shots``, ``unadapted`` and ``error`` [%]; the change of the source model, ``value``,
        ``low``, ``high`` [points]; and the difference to ``reference``, the best method without adaptation in this
        scenario (empty without one): ``best``, ``best_low``, ``best_high`` [points].
    """
    rows = []
    for (key, run), scenario in zip(runs.iterrows(), _scenarios(runs), strict=True):
        target, *counts = (str(run.dropna().get(name, "None")) for name in SCENARIO)
        best, errors = unadapted.get(scenario, ("", None))
        for shots, part in adapted[str(key)].groupby("shots"):
            change = with_intervals({"gain": part.assign(error=part["error"] - part["unadapted"])}, "map").loc["gain"]
            to_best = pd.Series(np.nan, ["value", "low", "high"])
            if errors is not None:
                to_best = difference(paired({"adapted": part, best: errors}), "adapted", best)
            rows.append({
                "scenario": scenario, "method": run["method"], "shots": int(cast(int, shots)),
                "unadapted": part["unadapted"].mean(), "error": part["error"].mean(), **change, "reference": best,
                "best": to_best["value"], "best_low": to_best["low"], "best_high": to_best["high"],
                "order": (target, *(float("inf") if count == "None" else float(count) for count in counts)),
            })  # fmt: skip
    table = pd.DataFrame(rows).drop_duplicates(["scenario", "method", "shots"])
    return table.sort_values(["order", "shots", "method"], ignore_index=True).drop(columns="order")


def map_text(table: pd.DataFrame) -> pd.DataFrame:
    """Result of :func:`transfer_map` with a verdict."""
    to_best = text_of(table, "best")
    return pd.DataFrame(
        {
            "scenario": table["scenario"],
            "method": table["method"],
            "K": table["shots"].astype(str),
            "source model [%]": [number(value) for value in table["unadapted"]],
            "adapted [%]": [number(value) for value in table["error"]],
            "change [points]": text_of(table),
            "pays": verdicts(table),
            "change to the best without adaptation [points]": [
                f"{name}: {text}" if name else "-" for name, text in zip(table["reference"], to_best, strict=True)
            ],
        }
    ).set_index(["scenario", "method"])


def map_sentence(table: pd.DataFrame) -> str:
    """In how many cases adapting pays, against the source model and the best method without adaptation."""
    transferred = table[~table["method"].str.endswith(FROM_SCRATCH)]
    compared = transferred[transferred["reference"] != ""]
    text = (
        f"Adapting pays in {(transferred['high'] < 0).sum()} of {len(transferred)} cases (a scenario and a number of "
        "shots): the whole 95 % interval of the change of the source model lies below 0. "
    )
    if compared.empty:
        return text + (
            "The best method without adaptation was not run in these scenarios. Add methods with 'swg train "
            "experiment=transfer_map adaptation=none classifier=extra_trees'."
        )
    return text + (
        f"In comparison with the best method without adaptation, adapting is clearly better in "
        f"{(compared['best_high'] < 0).sum()} of {len(compared)} cases and clearly worse in "
        f"{(compared['best_low'] > 0).sum()}."
    )


def verdicts(table: pd.DataFrame) -> list[str]:
    """Whether adapting pays, from the interval of the change, per row of :func:`transfer_map`."""
    texts = []
    for method, low, high in zip(table["method"], table["low"], table["high"], strict=True):
        if method.endswith(FROM_SCRATCH):
            texts.append("-")
        elif not np.isfinite(high):
            texts.append("too few gears")
        else:
            texts.append("yes" if high < 0 else "harms" if low > 0 else "not clearly")
    return texts


def disturbed_cases(runs: pd.DataFrame) -> pd.DataFrame:
    """Accuracy in the three cases of Table X (columns) of every method (rows), the paper's own figures first [%].

    Raises
    ------
    ValueError
        If the paper's forest was not run.
    """
    paper = paper_table("table10").query("classifier == 'rf' and features == 'selection_3'")
    cases = list(paper["row"])
    ours = by_method(runs)[[f"test/{metric_key(case)}" for case in cases]].set_axis(cases, axis="columns")
    if DISTURBED_FOREST not in ours.index:
        raise ValueError(
            f"no run of the {DISTURBED_FOREST} on the disturbed data: add classifier=rf features=selection_3"
        )
    theirs = pd.DataFrame([paper["paper"].to_numpy()], index=[PUBLISHED], columns=cases)
    return pd.concat([theirs, ours.astype(float)]).rename_axis("method")


def best_disturbed(cases: pd.DataFrame) -> str:
    """Our method with the highest accuracy in its worst case."""
    return str(cases.iloc[1:].min(axis="columns").idxmax())
