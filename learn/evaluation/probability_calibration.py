"""Whether a predicted probability is the share that is right, and one number that makes it more so: the temperature."""

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

# A class that a forest gives no vote at all has the probability 0, whose logarithm would be minus infinity.
SMALLEST = 1e-6
COLDEST, HOTTEST = 0.05, 20.0


def reliability(
    probabilities: Float[np.ndarray, "row class"], y: Int[np.ndarray, " row"], bins: int = 15
) -> pd.DataFrame:
    """Confidence against accuracy in bins of equally many rows.

    Rows of the same confidence stay in one bin, so there may be fewer bins than asked for; a forest's votes tie often.

    Parameters
    ----------
    probabilities : array (row, class)
    y : array (row,)
        Column of the true class.
    bins : int

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
    """Mean distance of confidence and accuracy over the rows of a reliability table [points].

    It is not 0 for a calibrated method: chance alone moves the accuracy of a bin of n rows by about 0.4 / sqrt(n).
    """
    return 100 * float(np.average((table["confidence"] - table["accuracy"]).abs(), weights=table["count"]))


def negative_log_likelihood(probabilities: Float[np.ndarray, "row class"], y: Int[np.ndarray, " row"]) -> float:
    """Mean of minus the logarithm of the true class's probability [nat], which counts as at least 1e-6."""
    return -float(np.mean(np.log(np.maximum(probabilities[np.arange(len(y)), y], SMALLEST))))


def apply_temperature(
    probabilities: Float[np.ndarray, "row class"], temperature: float
) -> Float[np.ndarray, "row class"]:
    """Probabilities to the power 1 / temperature, scaled to sum 1; above 1 they become more even.

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
    """The temperature from 0.05 to 20 of the highest likelihood (Guo et al., ICML 2017).

    Fit it on validation predictions of the source gears: those of the gear to be judged have no labels.

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
    """Probabilities of every gear with the temperature that the predictions on all the other gears give.

    Predictions on a gear enter its own temperature nowhere. Its labels may still: where gears are judged in folds, the
    models that judge the others have learnt from it.

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
        The temperatures, by the number of the gear.

    Raises
    ------
    ValueError
        If there is one gear only.
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
