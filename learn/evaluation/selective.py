"""Saying "I do not know": decide on sure recordings only, give sets of classes, and notice gears unlike the others."""

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float, Int


def risk_coverage(confidence: Float[np.ndarray, " row"], correct: Bool[np.ndarray, " row"]) -> pd.DataFrame:
    """Share of errors among the surest recordings, as ever more of them are decided.

    Rows of the same confidence are decided together or not at all.

    Parameters
    ----------
    confidence : array (row,)
        Higher is surer; for probabilities the highest one of the row.
    correct : array (row,) of bool

    Returns
    -------
    DataFrame
        ``confidence`` (lowest decided), ``coverage`` (share decided) and ``risk`` (share of these that is wrong).
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
    """Mean risk over all coverages; 0 for a method that is never wrong."""
    return float((curve["risk"] * np.diff(curve["coverage"], prepend=0)).sum())


def coverage_at(curve: pd.DataFrame, error: float) -> float:
    """Largest share that can be decided with at most this share of errors, 0 if none can.

    The threshold is chosen with the labels of the same recordings, so it says what is possible, not what is promised.
    """
    return float(curve.loc[curve["risk"] <= error, "coverage"].max()) if (curve["risk"] <= error).any() else 0.0


def conformal_threshold(
    probabilities: Float[np.ndarray, "row class"],
    y: Int[np.ndarray, " row"],
    gears: np.ndarray,
    nominal: float,
) -> float:
    """The lowest probability with which a class still belongs to the set of a recording of a new gear.

    Recordings of one gear are not exchangeable with those of another, gears are. Every calibration gear therefore
    has the weight 1 / (gears + 1), spread over its recordings, and the new gear has the rest (Lee, Barber and
    Willett 2023, arXiv 2306.06342). With one recording per gear this is split conformal prediction.

    Parameters
    ----------
    probabilities : array (row, class)
        Of calibration gears, on none of which the method was trained.
    y : array (row,)
        Column of the true class.
    gears : array (row,)
        Gear of each row.
    nominal : float
        Share of recordings whose set shall hold the true class.

    Returns
    -------
    float
        Minus infinity where there are too few gears for the promise: then a set holds every class.

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
    """Which classes belong to the set of each recording."""
    return probabilities >= threshold


def set_figures(sets: Bool[np.ndarray, "row class"], y: Int[np.ndarray, " row"], gears: np.ndarray) -> pd.DataFrame:
    """How often the sets hold the truth, and how large they are, one row per gear.

    Returns
    -------
    DataFrame
        ``coverage`` (share of sets with the true class), ``mean_size`` and ``empty`` (share of sets without a class).
        The promise is about the mean coverage over gears; single gears may lie far below.
    """
    sizes = sets.sum(axis=1)
    rows = pd.DataFrame({"coverage": sets[np.arange(len(y)), y], "mean_size": sizes, "empty": sizes == 0})
    return rows.groupby(pd.Index(gears, name="gear")).mean()


def gear_novelty(
    source: Float[np.ndarray, "gear feature"], target: Float[np.ndarray, "target feature"]
) -> Float[np.ndarray, " target"]:
    """Mahalanobis distance of gears from the source gears, per square root of the number of features.

    There are fewer gears than features, so the covariance between gears is shrunk (Ledoit and Wolf, 2004), after every
    feature is scaled by its spread over the source gears.

    Parameters
    ----------
    source : array (gear, feature)
        One row per source gear: the means of its healthy references, the operating points side by side.
    target : array (target, feature)
        The same of gears that are not among the source gears; the distance of a source gear would come out too small.

    Raises
    ------
    ValueError
        If there are fewer than 3 source gears.
    """
    from sklearn.covariance import LedoitWolf

    if len(source) < 3:
        raise ValueError(f"{len(source)} source gears, at least 3 are needed to tell how far gears differ")
    spread = source.std(axis=0)
    used = spread > 1e-12 * np.abs(source).max(axis=0)
    middle, spread = source.mean(axis=0)[used], spread[used]
    covariance = LedoitWolf(assume_centered=True).fit((source[:, used] - middle) / spread)
    return np.sqrt(covariance.mahalanobis((target[:, used] - middle) / spread) / used.sum())


def novelty_left_out(gears: Float[np.ndarray, "gear feature"]) -> Float[np.ndarray, " gear"]:
    """Distance of every gear from all the others: what is usual for a gear of the same population."""
    return np.concatenate([gear_novelty(np.delete(gears, g, axis=0), gears[[g]]) for g in range(len(gears))])


def novelty_auroc(usual: Float[np.ndarray, " known"], novel: Float[np.ndarray, " novel"]) -> float:
    """Probability that a novel gear scores above a usual one; 0.5 is chance, 1 tells all of them apart."""
    from sklearn.metrics import roc_auc_score

    truth = np.concatenate([np.zeros(len(usual)), np.ones(len(novel))])
    return float(roc_auc_score(truth, np.concatenate([usual, novel])))
