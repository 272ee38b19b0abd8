"""Calibration, abstention and prediction sets of methods."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from learn.evaluation.decisions import class_numbers, probabilities
from learn.evaluation.probability_calibration import (
    expected_calibration_error,
    negative_log_likelihood,
    reliability,
    tempered_by_others,
)
from learn.evaluation.selective import area_under_risk, class_thresholds, coverage_at, risk_coverage
from learn.transfer_report.tables import number

NOMINAL = 0.9  # coverage at which prediction sets aim


def reliabilities(predictions: Mapping[str, pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """Confidence and accuracy in bins, of every method."""
    return {name: reliability(probabilities(table), class_numbers(table)) for name, table in predictions.items()}


def risk_curves(predictions: Mapping[str, pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """Error among the most confident recordings against their share, of every method."""
    curves = {}
    for name, table in predictions.items():
        p = probabilities(table)
        curves[name] = risk_coverage(p.max(axis=1), p.argmax(axis=1) == class_numbers(table))
    return curves


def calibration_text(predictions: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Calibration without and with a temperature, and the shares of recordings that can be decided, per method."""
    curves, rows = risk_curves(predictions), {}
    for name, table in predictions.items():
        p, y, gears = probabilities(table), class_numbers(table), table["gear"].to_numpy()
        tempered, temperatures = tempered_by_others(p, y, gears) if len(np.unique(gears)) > 1 else (None, None)
        rows[name] = {
            "calibration error [points]": number(expected_calibration_error(reliability(p, y))),
            "negative log-likelihood [nat]": number(negative_log_likelihood(p, y), digits=2),
            "temperatures": "-" if temperatures is None else f"{temperatures.min():.2f} to {temperatures.max():.2f}",
            "calibration error with temperature [points]": (
                "-" if tempered is None else number(expected_calibration_error(reliability(tempered, y)))
            ),
            "negative log-likelihood with temperature [nat]": (
                "-" if tempered is None else number(negative_log_likelihood(tempered, y), digits=2)
            ),
            "area under risk and coverage [%]": number(100 * area_under_risk(curves[name])),
            "decided at 5 % error [%]": number(100 * coverage_at(curves[name], 0.05), digits=0),
            "decided at 1 % error [%]": number(100 * coverage_at(curves[name], 0.01), digits=0),
        }
    return pd.DataFrame(rows).T.rename_axis("method")


def conformal(predictions: pd.DataFrame) -> pd.DataFrame:
    """Prediction sets: ``label``, ``gear``, ``covered`` and ``size`` of every row.

    Every class of every gear has its own threshold, from recordings of the class on all other gears. Models of other
    folds may have been trained on the gear, so :data:`NOMINAL` is then a target without guarantee.
    """
    p, y, gears = probabilities(predictions), class_numbers(predictions), predictions["gear"].to_numpy()
    sets = np.zeros(p.shape, bool)
    for gear in np.unique(gears):
        here = gears == gear
        sets[here] = p[here] >= class_thresholds(p[~here], y[~here], gears[~here], NOMINAL)
    covered = sets[np.arange(len(y)), y]
    return predictions[["label", "gear"]].assign(covered=covered, size=sets.sum(axis=1))


def sets_text(predictions: pd.DataFrame, of: str) -> str:
    """Coverage and size of the prediction sets of recordings or units."""
    sets = conformal(predictions)
    gears = sets["gear"].nunique()
    if sets["size"].min() >= len(predictions["label"].unique()):
        return f"Prediction sets of {of}: {gears} gears are too few for a coverage of {100 * NOMINAL:.0f} %."
    by_class = 100 * sets.groupby(sets["label"].astype(str))["covered"].mean()
    return (
        f"Prediction sets of {of}: the true class is in the set of {100 * sets['covered'].mean():.1f} % of them, and "
        f"of {by_class.min():.0f} to {by_class.max():.0f} % in the single classes. A set has {sets['size'].mean():.2f} "
        f"classes on average; {100 * np.mean(sets['size'] == 0):.1f} % are empty."
    )
