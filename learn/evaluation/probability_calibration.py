"""Calibration of predicted probabilities, and its improvement by a temperature."""

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from learn.methods.product import SMALLEST

COLDEST, HOTTEST = 0.05, 20.0


def reliability(
    probabilities: Float[np.ndarray, "row class"], y: Int[np.ndarray, " row"], bins: int = 15
) -> pd.DataFrame:
    """Confidence and accuracy in bins with equal numbers of rows.

    Rows of equal confidence share a bin, so there may be fewer bins; votes of a forest are often equal.

    Parameters
    ----------
    probabilities : array (row, class)
    y : array (row,)
        Column of the true class.
    bins : int
        Largest number of bins.

    Returns
    -------
    DataFrame
        One row per bin: mean ``confidence`` (highest probability) and ``accuracy``, both 0 to 1, and ``count``.
    """
    confidence = probabilities.max(axis=1)
    rows = pd.DataFrame({"confidence": confidence, "accuracy": probabilities.argmax(axis=1) == y})
    edges = np.unique(np.quantile(confidence, np.linspace(0, 1, bins + 1)[1:-1]))
    grouped = rows.groupby(np.searchsorted(edges, confidence))
    return grouped.mean().assign(count=grouped.size()).reset_index(drop=True)


def expected_calibration_error(table: pd.DataFrame) -> float:
    """Mean difference of confidence and accuracy over a table of :func:`reliability` [points].

    It is above 0 for a calibrated method too, as chance changes the accuracy of a bin of n rows by about 0.4 / sqrt(n).
    """
    return 100 * float(np.average((table["confidence"] - table["accuracy"]).abs(), weights=table["count"]))


def negative_log_likelihood(probabilities: Float[np.ndarray, "row class"], y: Int[np.ndarray, " row"]) -> float:
    """Mean negative logarithm of the probability of the true class, bounded below by 1e-6 [nat]."""
    return -float(np.mean(np.log(np.maximum(probabilities[np.arange(len(y)), y], SMALLEST))))


def apply_temperature(
    probabilities: Float[np.ndarray, "row class"], temperature: float
) -> Float[np.ndarray, "row class"]:
    """Probabilities to the power of 1 / temperature, normalised; temperatures above 1 make them more equal.

    Raises
    ------
    ValueError
        If the temperature is not above 0.
    """
    if not temperature > 0:
        raise ValueError(f"temperature {temperature} must be above 0; 1 changes nothing")
    logits = np.log(np.maximum(probabilities, SMALLEST)) / temperature
    powers = np.exp(logits - logits.max(axis=1, keepdims=True))
    return powers / powers.sum(axis=1, keepdims=True)


def fit_temperature(probabilities: Float[np.ndarray, "row class"], y: Int[np.ndarray, " row"]) -> float:
    """Temperature from 0.05 to 20 with the highest likelihood (Guo et al., ICML 2017).

    It needs predictions on labelled gears that are not judged.

    Parameters
    ----------
    probabilities : array (row, class)
    y : array (row,)
        Column of the true class.
    """
    from scipy.optimize import minimize_scalar

    fitted = minimize_scalar(
        lambda logarithm: negative_log_likelihood(apply_temperature(probabilities, float(np.exp(logarithm))), y),
        bounds=(np.log(COLDEST), np.log(HOTTEST)),
        method="bounded",
    )
    return float(np.exp(fitted.x))


def tempered_by_others(
    probabilities: Float[np.ndarray, "row class"], y: Int[np.ndarray, " row"], gears: np.ndarray
) -> tuple[Float[np.ndarray, "row class"], Float[np.ndarray, " gear"]]:
    """Probabilities of every gear with the temperature that fits the predictions on all other gears.

    Predictions on a gear do not affect its temperature. Its labels may: with folds, models for other gears were trained
    on it.

    Parameters
    ----------
    probabilities : array (row, class)
    y : array (row,)
        Column of the true class.
    gears : array (row,)
        Gear of each row.

    Returns
    -------
    array (row, class)
    array (gear,)
        Temperatures in ascending order of gear numbers.

    Raises
    ------
    ValueError
        If there is only one gear.
    """
    names = np.unique(gears)
    if len(names) < 2:
        raise ValueError(
            f"{len(names)} gear, at least 2 are needed to fit the temperature of one on the others: judge more gears"
        )
    result, temperatures = np.empty_like(probabilities), np.empty(len(names))
    for number, gear in enumerate(names):
        here = gears == gear
        temperatures[number] = fit_temperature(probabilities[~here], y[~here])
        result[here] = apply_temperature(probabilities[here], temperatures[number])
    return result, temperatures
