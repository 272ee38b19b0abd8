"""Units whose recordings a method is given together, in one row, beside the product of posteriors."""

from typing import Any

import pandas as pd

from learn.transfer_report.runs import JOINT, Runs, by_method
from learn.transfer_report.tables import REZERO, in_json, number, with_intervals

PRODUCT, TOGETHER, ON_HARMONICS = "product of posteriors", "joint row", " on harmonics"


def joint_units(runs: Runs) -> pd.DataFrame:
    """Errors of methods on joint rows.

    Returns
    -------
    DataFrame
        One row for each ``method`` and number ``healthy`` of healthy specimens of the session (0: without rezero), with
        ``value``, ``low`` and ``high`` [%]. It is empty if the study was not run.
    """
    study = runs.of_study("units")
    if study.empty:
        return pd.DataFrame(columns=["method", "healthy", "value", "low", "high"])
    plain, corrected = (by_method(study[study["adaptation"] == name]) for name in ("none", "rezero"))
    rows = [with_intervals(runs.errors(plain), "joint units").assign(healthy=0)] if len(plain) else []
    for name, specimens in runs.tables(corrected, "specimens").items():
        for healthy, part in specimens[specimens["shots"] > 0].groupby("shots"):
            row = with_intervals({name.removesuffix(REZERO): part}, f"joint units, {healthy}")
            rows.append(row.assign(healthy=healthy))
    return pd.concat(rows).rename_axis("method").reset_index()


def joint_units_text(joint: pd.DataFrame, of_units: pd.DataFrame, few: pd.DataFrame) -> pd.DataFrame:
    """Errors of every method (rows) by the product of its posteriors and on joint rows, by healthy specimens (columns).

    Parameters
    ----------
    joint : DataFrame
        Result of :func:`joint_units`.
    of_units, few : DataFrame
        Errors by the product, without and with rezero: results of :func:`.twins.errors` and :func:`.tables.few_shot`.
    """
    corrected = few[few["method"].str.endswith(REZERO)]
    product = corrected.assign(method=corrected["method"].str.removesuffix(REZERO) + ON_HARMONICS)
    by_product = product.set_index(["method", "shots"])[["unit", "unit_low", "unit_high"]]
    cells: dict[str, dict[str, str]] = {}
    for method, rows in joint.assign(method=joint["method"].str.removesuffix(JOINT)).groupby("method", sort=False):
        row = cells[str(method)] = {}
        for healthy, *figure in rows.sort_values("healthy")[["healthy", "value", "low", "high"]].to_numpy():
            given = f", rezero K = {healthy:.0f}" if healthy else ""
            known, key = (by_product, (method, healthy)) if healthy else (of_units[["value", "low", "high"]], method)
            row[PRODUCT + given] = number(*known.loc[key]) if key in known.index else "-"
            row[TOGETHER + given] = number(*figure)
    return pd.DataFrame.from_dict(cells, orient="index").fillna("-").rename_axis("method")


def joint_units_json(joint: pd.DataFrame) -> dict[str, Any]:
    """Errors [%] by the name of the method, with the number of healthy specimens of the session."""
    return {
        f"{row['method']}{REZERO} (K = {row['healthy']})" if row["healthy"] else row["method"]: in_json(row)
        for _, row in joint.iterrows()
    }
