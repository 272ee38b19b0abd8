"""How large a fault must be to be found, how often a healthy gear alarms, and where recognition is worst."""

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
    """Whether a recording was taken for any fault."""
    return decisions(predictions) != "healthy"


def identified(predictions: pd.DataFrame) -> Bool[np.ndarray, " row"]:
    """Whether the decision is right."""
    return decisions(predictions) == truth(predictions)


def detection_table(
    predictions: pd.DataFrame, hits: Bool[np.ndarray, " row"], by: Sequence[str] = OPERATING_POINT
) -> pd.DataFrame:
    """Sizes found per fault class and operating point, or over all of them with ``by=()``.

    Parameters
    ----------
    predictions : DataFrame
    hits : array (row,) of bool
        :func:`detected` or :func:`identified` of these predictions.
    by : sequence of str
        Columns whose values get a row of their own.

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
    """Share of healthy recordings that alarm [%], with Wilson's 95 % interval at the effective number of recordings.

    That number is the one whose binomial variance is the variance between gears (Dean and Pagano, Journal of Survey
    Statistics and Methodology 3, 2015), not more than there are healthy specimens and not fewer than gears. Without
    any alarm nothing is known of how alarms cluster, and the specimens count as independent.

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
    """Share recognised [%] of every class (columns) at every operating point (rows)."""
    rows = predictions[list(OPERATING_POINT)].assign(label=truth(predictions), right=identified(predictions))
    shares = 100 * rows.groupby([*OPERATING_POINT, "label"])["right"].mean().unstack("label")
    return shares[[label for label in CLASSES if label in shares]]


def worst_cell(predictions: pd.DataFrame) -> pd.Series:
    """The operating point and class of which the smallest share is recognised; ``recall`` [%], ``recordings``.

    As the smallest of many shares it lies below what that cell would show on new recordings.
    """
    recall = recall_by_cell(predictions).stack()
    speed, load, label = cast(tuple[float, float, str], recall.idxmin())
    inside = (predictions["n_in_rpm"] == speed) & (predictions["T_out_nm"] == load) & (truth(predictions) == label)
    facts = {"n_in_rpm": speed, "T_out_nm": load, "label": label}
    return pd.Series({**facts, "recall": recall.min(), "recordings": int(inside.sum())})
