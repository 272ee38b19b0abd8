"""Units whose recordings a method is given together, in one row, beside the product of posteriors."""

from typing import Any

import pandas as pd

from learn.transfer_report.runs import JOINT, Runs, by_method
from learn.transfer_report.tables import REZERO, in_json, number, with_intervals

PRODUCT, TOGETHER = "product of posteriors", "joint row"


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
    rows = []
    plain, adapted = (by_method(study[same]) for same in (study["adaptation"] == "none", study["adaptation"] != "none"))
    if len(plain):
        rows.append(with_intervals(runs.errors(plain), "joint units").assign(healthy=0))
    for name, specimens in runs.tables(adapted, "specimens").items():
        for healthy, part in specimens[specimens["shots"] > 0].groupby("shots"):
            row = with_intervals({name.removesuffix(REZERO): part}, f"joint units, {healthy}")
            rows.append(row.assign(healthy=healthy))
    return pd.concat(rows).rename_axis("method").reset_index()


def joint_units_text(joint: pd.DataFrame, of_units: pd.DataFrame) -> pd.DataFrame:
    """Errors of every method (rows) by the product of its posteriors and on joint rows, by healthy specimens (columns).

    `of_units` are the errors by the product (:func:`.twins.errors`), by the method's name without :data:`JOINT`.
    """
    names = [TOGETHER if not k else f"{TOGETHER}, rezero K = {k}" for k in joint["healthy"]]
    figures = [number(*each) for each in joint[["value", "low", "high"]].to_numpy(dtype=float)]
    alone = joint["method"].str.removesuffix(JOINT)
    wide = joint.assign(method=alone, how=names, text=figures).pivot(index="method", columns="how", values="text")
    product = of_units.reindex(wide.index)[["value", "low", "high"]].to_numpy(dtype=float)
    wide.insert(0, PRODUCT, [number(*each) for each in product])
    return wide.fillna("-").rename_axis(None, axis="columns")


def joint_units_json(joint: pd.DataFrame) -> dict[str, Any]:
    """Errors [%] by the name of the method, with the number of healthy specimens of the session."""
    return {
        f"{row['method']}{REZERO} (K = {row['healthy']})" if row["healthy"] else row["method"]: in_json(row)
        for _, row in joint.iterrows()
    }
