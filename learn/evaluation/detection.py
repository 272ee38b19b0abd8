"""Probability of detection, false alarms, and the operating point and class with the lowest recall."""

from collections.abc import Sequence
from typing import cast

import numpy as np
import pandas as pd
from jaxtyping import Bool

from learn.evaluation.bootstrap import FEWEST_GEARS
from learn.evaluation.decisions import decisions, truth
from learn.evaluation.detection_curve import detection
from learn.inputs.inputs import OPERATING_POINT
from learn.protocols.fault_size import UNITS, size
from swgsim.storage.labelled_signals import CLASSES


def detected(predictions: pd.DataFrame) -> Bool[np.ndarray, " row"]:
    """Whether the decision is a fault, right or wrong."""
    return decisions(predictions) != "healthy"


def identified(predictions: pd.DataFrame) -> Bool[np.ndarray, " row"]:
    """Whether the decision is correct."""
    return decisions(predictions) == truth(predictions)


def detection_table(
    predictions: pd.DataFrame, hits: Bool[np.ndarray, " row"], by: Sequence[str] = OPERATING_POINT
) -> pd.DataFrame:
    """Detectable sizes by fault class and operating point, or over all operating points with ``by=()``.

    Parameters
    ----------
    predictions : DataFrame
    hits : array (row,) of bool
        :func:`detected` or :func:`identified` of these predictions.
    by : sequence of str
        Columns whose values have separate rows.

    Returns
    -------
    DataFrame
        ``label``, the columns of `by`, ``hits`` [%], ``a50``, ``a90``, ``a90_95`` and ``reason``.
    """
    faulty = predictions.assign(hit=hits, label=truth(predictions))[truth(predictions) != "healthy"]
    rows = []
    for keys, part in faulty.groupby(["label", *by], sort=True):
        sizes = size(str(keys[0]), part["severity"].to_numpy(dtype=float))
        hit = part["hit"].to_numpy(dtype=bool)
        fitted = detection(sizes, hit, part["gear"].to_numpy(), UNITS.get(str(keys[0]), ""))
        facts = {"hits": 100 * part["hit"].mean(), "a50": fitted.a50, "a90": fitted.a90, "a90_95": fitted.a90_95}
        rows.append({**dict(zip(["label", *by], keys, strict=True)), **facts, "reason": fitted.reason})
    return pd.DataFrame(rows)


def false_alarm_rate(predictions: pd.DataFrame) -> dict[str, float]:
    """Share of healthy recordings with an alarm [%], and Wilson's 95 % interval for the effective number of recordings.

    This number has a binomial variance equal to the variance between gears (Dean and Pagano, Journal of Survey
    Statistics and Methodology 3, 2015). It lies between the numbers of gears and of healthy specimens. Without an
    alarm, specimens count as independent.

    Returns
    -------
    dict
        ``rate``, ``low``, ``high`` [%]; ``gears`` and ``alarming_gears``. The interval is NaN with fewer than 5 gears.
    """
    from statsmodels.stats.proportion import proportion_confint

    healthy = predictions.assign(alarm=detected(predictions))[truth(predictions) == "healthy"]
    if healthy.empty:
        raise ValueError("no healthy recording among the predictions: add healthy specimens to judge false alarms")
    by_gear = healthy.groupby("gear")["alarm"].mean()
    rate, count = float(by_gear.mean()), len(by_gear)
    low = high = np.nan
    if count >= FEWEST_GEARS:
        between = by_gear.var() / count
        specimens = len(healthy[["gear", "variant"]].drop_duplicates())
        independent = np.clip(rate * (1 - rate) / between, count, specimens) if between > 0 else specimens
        low, high = proportion_confint(rate * independent, independent, method="wilson")
    shares = {"rate": 100 * rate, "low": 100 * float(low), "high": 100 * float(high)}
    return {**shares, "gears": float(count), "alarming_gears": float((by_gear > 0).sum())}


def recall_by_cell(predictions: pd.DataFrame) -> pd.DataFrame:
    """Recall [%] of every class (column) at every operating point (row)."""
    rows = predictions[list(OPERATING_POINT)].assign(label=truth(predictions), right=identified(predictions))
    shares = 100 * rows.groupby([*OPERATING_POINT, "label"])["right"].mean().unstack("label")
    return shares[[label for label in CLASSES if label in shares]]


def worst_cell(predictions: pd.DataFrame) -> pd.Series:
    """Operating point and class with the lowest recall; ``recall`` [%], ``recordings``.

    As the minimum of many estimates, it is lower than the recall of that cell on new recordings.
    """
    recall = recall_by_cell(predictions).stack()
    speed, load, label = cast(tuple[float, float, str], recall.idxmin())
    inside = (predictions["n_in_rpm"] == speed) & (predictions["T_out_nm"] == load) & (truth(predictions) == label)
    facts = {"n_in_rpm": speed, "T_out_nm": load, "label": label}
    return pd.Series({**facts, "recall": recall.min(), "recordings": int(inside.sum())})
