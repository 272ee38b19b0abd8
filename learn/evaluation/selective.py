"""Abstention: decisions on confident recordings only, sets of classes, and novelty of gears."""

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


def prediction_sets(probabilities: Float[np.ndarray, "row class"], threshold: float) -> Bool[np.ndarray, "row class"]:
    """Classes in the prediction set of each recording."""
    return probabilities >= threshold


def set_figures(sets: Bool[np.ndarray, "row class"], y: Int[np.ndarray, " row"], gears: np.ndarray) -> pd.DataFrame:
    """Coverage and size of the prediction sets of each gear.

    Returns
    -------
    DataFrame
        ``coverage`` (share of sets with the true class), ``mean_size`` and ``empty`` (share of empty sets). The nominal
        coverage applies to the mean over gears; single gears may have much less.
    """
    sizes = sets.sum(axis=1)
    rows = pd.DataFrame({"coverage": sets[np.arange(len(y)), y], "mean_size": sizes, "empty": sizes == 0})
    return rows.groupby(pd.Index(gears, name="gear")).mean()


def gear_novelty(
    source: Float[np.ndarray, "gear feature"], target: Float[np.ndarray, "target feature"]
) -> Float[np.ndarray, " target"]:
    """Mahalanobis distance of gears to the source gears, divided by the root of the number of features.

    There are fewer gears than features, so the covariance between gears is shrunk (Ledoit and Wolf, 2004). Before,
    every feature is divided by its standard deviation over the source gears.

    Parameters
    ----------
    source : array (gear, feature)
        One row per source gear: means of its healthy references at all operating points.
    target : array (target, feature)
        The same of other gears; the distance of a source gear would be too small.

    Raises
    ------
    ValueError
        If there are fewer than 3 source gears.
    """
    from sklearn.covariance import LedoitWolf

    if len(source) < 3:
        raise ValueError(f"{len(source)} source gears, at least 3 are needed for the spread of gears")
    spread = source.std(axis=0)
    used = spread > 1e-12 * np.abs(source).max(axis=0)
    middle, spread = source.mean(axis=0)[used], spread[used]
    covariance = LedoitWolf(assume_centered=True).fit((source[:, used] - middle) / spread)
    return np.sqrt(covariance.mahalanobis((target[:, used] - middle) / spread) / used.sum())


def novelty_left_out(gears: Float[np.ndarray, "gear feature"]) -> Float[np.ndarray, " gear"]:
    """Leave-one-out distance of every gear to all others: the usual distances within a population."""
    return np.concatenate([gear_novelty(np.delete(gears, g, axis=0), gears[[g]]) for g in range(len(gears))])


def novelty_auroc(usual: Float[np.ndarray, " known"], novel: Float[np.ndarray, " novel"]) -> float:
    """Probability that a novel gear has a larger distance than a usual one; 0.5 is chance, 1 is full separation."""
    from sklearn.metrics import roc_auc_score

    truth = np.concatenate([np.zeros(len(usual)), np.ones(len(novel))])
    return float(roc_auc_score(truth, np.concatenate([usual, novel])))
