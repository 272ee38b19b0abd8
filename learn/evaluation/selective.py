"""Abstention: decisions on confident recordings only, and sets of classes."""

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float, Int


def risk_coverage(confidence: Float[np.ndarray, " row"], correct: Bool[np.ndarray, " row"]) -> pd.DataFrame:
    """Share of errors among the most confident recordings, as a function of the share that is decided.

    Rows of equal confidence are decided together.

    Parameters
    ----------
    confidence : array (row,)
        Such as the highest probability of each row.
    correct : array (row,) of bool

    Returns
    -------
    DataFrame
        ``confidence`` (threshold), ``coverage`` (share of decided rows) and ``risk`` (share of errors among them).
    """
    order = np.argsort(-confidence, kind="stable")
    decided = np.arange(1, len(order) + 1)
    curve = pd.DataFrame(
        {
            "confidence": confidence[order],
            "coverage": decided / len(order),
            "risk": np.cumsum(~correct[order]) / decided,
        }
    )
    return curve.drop_duplicates("confidence", keep="last", ignore_index=True)


def area_under_risk(curve: pd.DataFrame) -> float:
    """Mean risk over all coverages; 0 without errors."""
    return float((curve["risk"] * np.diff(curve["coverage"], prepend=0)).sum())


def coverage_at(curve: pd.DataFrame, error: float) -> float:
    """Largest coverage with at most this share of errors; 0 if no coverage has so few.

    The threshold uses the labels of the same recordings, so this is an upper limit for new recordings.
    """
    return float(curve.loc[curve["risk"] <= error, "coverage"].max()) if (curve["risk"] <= error).any() else 0.0


def conformal_threshold(
    probabilities: Float[np.ndarray, "row class"],
    y: Int[np.ndarray, " row"],
    gears: np.ndarray,
    nominal: float,
) -> float:
    """Lowest probability of the classes in the prediction set of a recording of a new gear.

    Gears are exchangeable, recordings of different gears are not. Every calibration gear therefore has the weight
    1 / (gears + 1), shared by its recordings, and the new gear has the rest (Lee, Barber and Willett 2023, arXiv
    2306.06342). With one recording per gear this is split conformal prediction.

    Parameters
    ----------
    probabilities : array (row, class)
        Predictions on calibration gears, which are not in training.
    y : array (row,)
        Column of the true class.
    gears : array (row,)
        Gear of each row.
    nominal : float
        Nominal coverage: share of recordings whose set contains the true class.

    Returns
    -------
    float
        Minus infinity if there are too few gears for this coverage; sets then contain all classes.

    Raises
    ------
    ValueError
        If `nominal` is not between 0 and 1.
    """
    if not 0 < nominal < 1:
        raise ValueError(f"nominal coverage {nominal} must be between 0 and 1, such as 0.9")
    numbers, counts = np.unique(gears, return_inverse=True, return_counts=True)[1:]
    true = probabilities[np.arange(len(y)), y]
    order = np.argsort(-true, kind="stable")
    weight = np.cumsum(1 / counts[numbers][order]) / (len(counts) + 1)
    enough = weight >= nominal - 1e-12
    return float(true[order][enough.argmax()]) if enough.any() else -np.inf


def class_thresholds(
    probabilities: Float[np.ndarray, "row class"], y: Int[np.ndarray, " row"], gears: np.ndarray, nominal: float
) -> Float[np.ndarray, " class"]:
    """A :func:`conformal_threshold` for every class, from its own recordings: the coverage then holds in each class.

    Also called Mondrian conformal prediction (Vovk, Asian Conference on Machine Learning, 2012).
    """
    of_class = (y == number for number in range(probabilities.shape[1]))
    return np.array([conformal_threshold(probabilities[r], y[r], gears[r], nominal) for r in of_class])
