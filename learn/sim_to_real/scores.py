"""Accuracy and false alarms of every model of a gear, with intervals over fault variants."""

from typing import cast

import numpy as np
import pandas as pd

from learn.evaluation.bootstrap import LEVEL, specimens
from learn.inputs.inputs import SPECIMEN
from learn.sim_to_real.judging import MODELS
from swgsim.common.seeds import generator

RESAMPLES = 2000


def scores(predictions: pd.DataFrame) -> pd.DataFrame:
    """Scores of every method, day of the references and model.

    All is of one gear. Intervals hold for further fault variants and healthy states of it, so specimens are resampled,
    within their class and for all models alike; they do not say what another gear would give.

    Parameters
    ----------
    predictions : DataFrame
        Of :func:`learn.sim_to_real.judging.judged`.

    Returns
    -------
    DataFrame
        ``method``, ``day``, ``model``; ``accuracy`` [%], the mean recall of the classes, and ``gain`` [points], its
        excess over the model without the effect; ``false_alarms`` [%], healthy recordings called faulty; and
        ``specimens``, the healthy ones. Each figure has its ``_low`` and ``_high``.
    """
    found = []
    for key, part in predictions.groupby(["method", "day"], sort=False):
        method, day = cast(tuple[str, str], key)
        errors = pd.concat(
            [specimens(of).set_index(list(SPECIMEN))["error"].rename(model) for model, of in part.groupby("model")],
            axis=1,
        )[list(MODELS)].reset_index()
        found.append(_of_models(errors).assign(method=method, day=day))
    table = pd.concat(found, ignore_index=True)
    return table[["method", "day", "model", *table.columns.drop(["method", "day", "model"])]]


def _of_models(errors: pd.DataFrame) -> pd.DataFrame:
    """Scores from the errors of every specimen under every model (column)."""
    values = errors.groupby("label")[list(MODELS)].mean()
    draws = _resampled(errors, generator("specimens of sim to real"))
    healthy = errors.loc[errors["label"] == "healthy", list(MODELS)]
    rows = []
    for model in MODELS:
        mean = float(values[model].mean())
        accuracy = _with_interval("accuracy", 100 - mean, 100 - draws[model])
        gain = _with_interval("gain", float(values["before"].mean()) - mean, draws["before"] - draws[model])
        rows.append({"model": model, **accuracy, **gain, **_false_alarms(healthy[model])})
    return pd.DataFrame(rows)


def _resampled(errors: pd.DataFrame, rng: np.random.Generator) -> pd.DataFrame:
    """Mean errors (draw x model) over specimens that are drawn with replacement within their class."""
    means = []
    for rows in errors.groupby("label").indices.values():
        values, count = errors[list(MODELS)].to_numpy(dtype=float)[rows], len(rows)
        means.append(rng.multinomial(count, np.full(count, 1 / count), size=RESAMPLES) @ values / count)
    return pd.DataFrame(np.mean(means, axis=0), columns=list(MODELS))


def _with_interval(name: str, value: float, draws: pd.Series) -> dict[str, float]:
    low, high = np.quantile(draws, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    return {name: value, f"{name}_low": float(low), f"{name}_high": float(high)}


def _false_alarms(errors: pd.Series) -> dict[str, float]:
    """Mean with Wilson's interval for as many independent answers as specimens: rather wide, also where none alarms."""
    from statsmodels.stats.proportion import proportion_confint

    count, rate = len(errors), float(errors.mean())
    low, high = proportion_confint(rate / 100 * count, count, alpha=1 - LEVEL, method="wilson")
    found = {"false_alarms": rate, "false_alarms_low": 100 * float(low), "false_alarms_high": 100 * float(high)}
    return {**found, "specimens": float(count)}
