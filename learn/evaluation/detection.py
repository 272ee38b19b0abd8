"""Alarms at a rate of false alarms, and the sizes of faults that they find."""

import numpy as np
import pandas as pd
from jaxtyping import Bool

from learn.evaluation.bootstrap import FEWEST_GEARS
from learn.evaluation.decisions import decisions, truth
from learn.evaluation.detection_curve import detection
from learn.inputs.inputs import OPERATING_POINT
from learn.protocols.fault_size import UNITS, size
from swgsim.storage.labelled_signals import CLASSES


def alarms(predictions: pd.DataFrame, rate: float) -> Bool[np.ndarray, " row"]:
    """Whether each row alarms, if the share `rate` of healthy rows may.

    A row alarms if its probability of healthy is as low as that of so few healthy rows of the other gears: the p-value
    (1 + number as low) / (1 + number) is at most `rate`. This keeps the rate if healthy rows of all gears scatter
    alike; :func:`false_alarm_rate` shows what it is. With fewer than 1 / rate - 1 healthy rows nothing alarms.
    """
    healthy, gears = predictions["healthy"].to_numpy(dtype=float), predictions["gear"].to_numpy()
    is_healthy, found = truth(predictions) == "healthy", np.zeros(len(predictions), bool)
    for gear in np.unique(gears):
        here = gears == gear
        others = np.sort(healthy[is_healthy & ~here])
        as_low = np.searchsorted(others, healthy[here], side="right")
        found[here] = 1 + as_low <= rate * (1 + len(others))
    return found


def detection_table(predictions: pd.DataFrame, alarm: Bool[np.ndarray, " row"]) -> pd.DataFrame:
    """Detectable sizes by fault class, over all operating points.

    Parameters
    ----------
    predictions : DataFrame
    alarm : array (row,)
        Such as of :func:`alarms`.

    Returns
    -------
    DataFrame
        One row per fault in the predictions: ``label``, ``hits`` [%], ``a90``, ``a90_95`` and ``reason``.
    """
    faulty = predictions.assign(hit=alarm, label=truth(predictions))[truth(predictions) != "healthy"]
    rows = []
    for key, part in faulty.groupby("label"):
        label, hits = str(key), part["hit"].to_numpy(dtype=bool)
        sizes = size(label, part["severity"].to_numpy(dtype=float))
        fitted = detection(sizes, hits, part["gear"].to_numpy(), UNITS.get(label, ""))
        facts = {"label": label, "hits": 100 * hits.mean(), "a90": fitted.a90, "a90_95": fitted.a90_95}
        rows.append({**facts, "reason": fitted.reason})
    return pd.DataFrame(rows)


def false_alarm_rate(predictions: pd.DataFrame, alarm: Bool[np.ndarray, " row"]) -> dict[str, float]:
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

    healthy = predictions.assign(alarm=alarm)[truth(predictions) == "healthy"]
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


def worst_cell(predictions: pd.DataFrame) -> pd.Series:
    """Operating point and class with the lowest recall; ``recall`` [%], ``recordings``.

    As the minimum of many estimates, it is lower than the recall of that cell on new recordings.
    """
    rows = predictions[list(OPERATING_POINT)].assign(label=pd.Categorical(truth(predictions), CLASSES))
    rows["right"] = decisions(predictions) == truth(predictions)
    cells = rows.groupby([*OPERATING_POINT, "label"], observed=True)["right"].agg(recall="mean", recordings="size")
    cells["recall"] *= 100
    return cells.reset_index().iloc[int(cells["recall"].argmin())]
