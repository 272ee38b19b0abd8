"""The studies of what a method sees as tables: inputs, the efficiency, the operating point, the healthy reference."""

from collections.abc import Mapping

import pandas as pd

from learn.evaluation.bootstrap import specimens
from learn.transfer_report.results import difference, with_intervals
from learn.transfer_report.runs import by_method, paired
from learn.transfer_report.sentences import of_row

INPUTS: Mapping[str, str] = {
    "raw": "raw",
    "differenced": "differenced",
    "selection_all": "features",
    "residual": "residual",
}
NETWORKS: Mapping[str, str] = {"perceptron": "mlp", "cnn": "cnn", "minirocket": "minirocket"}
WITHOUT_EFFICIENCY = ("False", "none")
GIVEN, WITHHELD = "with the operating point", "without"


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
            "efficiency": with_efficiency(runs),
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
    named = _with_keys(runs[with_efficiency(runs)])
    rows: dict[str, pd.Series] = {}
    for _, of_input in named.groupby("features"):
        errors = paired({str(name): specimens(predictions[str(key)]) for name, key in of_input["key"].items()})
        simple = [str(name) for name in of_input.index[of_input["classifier"] == "perceptron"]]
        others = [str(name) for name in of_input.index[of_input["classifier"] != "perceptron"]]
        rows |= {method: difference(errors, method, reference) for reference in simple for method in others}
    return pd.DataFrame(rows).T


def no_reference(bare: pd.DataFrame, runs: pd.DataFrame, predictions: Mapping[str, pd.DataFrame]) -> dict[str, str]:
    """Error of networks on raw signals without and with the healthy reference, as text.

    Parameters
    ----------
    bare, runs : DataFrame
        Of the studies ``no_reference`` and ``inputs``, with indices that differ.
    predictions : mapping
        Index of a run of either to its table of predictions.
    """
    without, known = _with_keys(bare), _with_keys(runs[(runs["features"] == "raw") & with_efficiency(runs)])
    keys = {f"{name}, Z0": key for name, key in without["key"].items()}
    keys |= {f"{name}, Z1": key for name, key in known["key"].items() if name in without.index}
    found = with_intervals({name: specimens(predictions[key]) for name, key in keys.items()}, "no reference")
    return {str(name): of_row(row) for name, row in found.sort_index().iterrows()}


def without_operating_point(runs: pd.DataFrame, predictions: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Error of every method with and without speed, load and temperature among its inputs, paired.

    Parameters
    ----------
    runs : DataFrame
        Of the study ``inputs_operating_point``.
    predictions : mapping
        Index of a run to its table of predictions.

    Returns
    -------
    DataFrame
        Per method ``given`` and ``withheld`` [%], and the second minus the first: ``value``, ``low``, ``high``
        [points].
    """
    is_given = runs["features.operating_point"] == "True"
    given, withheld = _with_keys(runs[is_given])["key"], _with_keys(runs[~is_given])["key"]
    rows = {}
    for method in given.index.intersection(withheld.index):
        keys = {GIVEN: given[method], WITHHELD: withheld[method]}
        errors = paired({name: specimens(predictions[key]) for name, key in keys.items()})
        means = {"given": errors[GIVEN].mean(), "withheld": errors[WITHHELD].mean()}
        rows[str(method)] = pd.Series(means | dict(difference(errors, WITHHELD, GIVEN)))
    return pd.DataFrame(rows, index=["given", "withheld", "value", "low", "high"]).T


def with_efficiency(runs: pd.DataFrame) -> pd.Series:
    """Which runs see the efficiency."""
    return ~runs["features.efficiency"].isin(WITHOUT_EFFICIENCY)


def _with_keys(runs: pd.DataFrame) -> pd.DataFrame:
    """The newest run of every method, with the method's name as index and the run's own index as ``key``."""
    return by_method(runs.rename(index=str).rename_axis("key").reset_index())
