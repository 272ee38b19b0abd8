"""What a workshop finds if 1 % of healthy recordings or units may alarm: shares and sizes of each fault."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from learn.evaluation.detection import alarms, detection_table, false_alarm_rate, worst_cell
from learn.protocols.fault_size import UNITS
from learn.transfer_report.tables import finite, number
from swgsim.common.style import words

RATE = 0.01  # of false alarms


def detections(of: str, predictions: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """What every method finds of every fault.

    Parameters
    ----------
    of : str
        What the rows of the tables are: recordings or units.
    predictions : mapping
        Method to its predictions.

    Returns
    -------
    DataFrame
        One row per method and fault, none if healthy rows are too few for the rate: ``method``, ``of``; ``rate``,
        ``low`` and ``high`` of false alarms [%]; the columns of :func:`learn.evaluation.detection.detection_table`.
    """
    gears = next(iter(predictions.values())).query("label == 'healthy'")["gear"].value_counts()
    if gears.sum() - gears.max() < 1 / RATE - 1:  # of the other gears, which set the limit
        return pd.DataFrame()
    parts = []
    for method, table in predictions.items():
        alarm = alarms(table, RATE)
        rate = {name: value for name, value in false_alarm_rate(table, alarm).items() if "gears" not in name}
        parts.append(detection_table(table, alarm).assign(method=method, of=of, **rate))
    return pd.concat(parts, ignore_index=True)


def detections_text(table: pd.DataFrame) -> pd.DataFrame:
    """Method and what it judges in rows, false alarms and faults in columns; a cell has the share and a90/95."""
    sizes = [_size_text(row) for row in table.to_dict("records")]
    cells = table.assign(
        text=[f"{hits:.0f} %; {size}" for hits, size in zip(table["hits"], sizes, strict=True)],
        alarms=[number(*each) for each in table[["rate", "low", "high"]].to_numpy(dtype=float)],
    )
    rows = ["method", "of", "alarms"]
    wide = cells.pivot(index=rows, columns="label", values="text").rename(columns=words)
    wide = wide.reindex(pd.MultiIndex.from_frame(cells[rows].drop_duplicates())).reset_index("alarms")
    return wide.rename(columns={"alarms": "false alarms [%]"}).rename_axis(None, axis="columns")


def _size_text(row: Mapping[Any, Any]) -> str:
    if not np.isnan(row["a90_95"]):
        return f"{row['a90_95']:.2g}{UNITS.get(row['label'], '')}"
    beyond = {"a90_95: below": "all sizes", "a90_95: not reached": "no size"}
    return next((text for start, text in beyond.items() if start in row["reason"]), "-")


def worst_text(predictions: pd.DataFrame) -> str:
    """The operating point and class with the smallest share of right decisions."""
    worst = worst_cell(predictions)
    return (
        f"The worst combination of class and operating point is {words(str(worst['label']))} at {worst['n_in_rpm']:g} "
        f"rpm and {worst['T_out_nm']:g} N m: {worst['recall']:.1f} % of {worst['recordings']} recordings are "
        "recognised."
    )


def detections_json(table: pd.DataFrame) -> dict[str, Any]:
    """Method to recordings or units to fault: ``found`` [%], ``a90``, ``a90_95``, and why a size is None."""
    nested: dict[str, Any] = {}
    for row in table.to_dict("records"):
        here = nested.setdefault(row["method"], {}).setdefault(row["of"], {"false_alarms": finite(row["rate"])})
        here[row["label"]] = {
            "found": finite(row["hits"]), **{name: _size(row[name]) for name in ("a90", "a90_95")},
            "reason": row["reason"] or None,
        }  # fmt: skip
    return nested


def _size(value: float) -> float | None:
    """Sizes are as small as micrometres in metres, so digits count and not decimals."""
    return float(f"{value:.3g}") if np.isfinite(value) else None
