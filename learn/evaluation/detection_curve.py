"""Probability of detection over fault size, fitted to hits and misses, and detectable sizes."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from learn.evaluation.bootstrap import FEWEST_GEARS

SIDE = 0.95
FOUND = 0.9
NAMES = ("a90", "a90_95")


@dataclass(frozen=True)
class DetectionCurve:
    """Probability of detection over fault size, with log-odds linear in log size (MIL-HDBK-1823A).

    Attributes
    ----------
    intercept, slope : float
        Coefficients of the log-odds over the natural logarithm of the size.
    covariance : array (coefficient, coefficient)
        Covariance of the coefficients, clustered by gear.
    quantile : float
        One-sided 95 % quantile of the confidence bounds; NaN with fewer than 5 gears.
    """

    intercept: float
    slope: float
    covariance: Float[np.ndarray, "2 2"]
    quantile: float

    def size_at(self, share: float) -> float:
        """Size that is detected with a probability of `share`."""
        return _from_log((np.log(share / (1 - share)) - self.intercept) / self.slope)

    def sure_size_at(self, share: float) -> float:
        """Size at which the lower 95 % bound reaches `share`, a90/95; infinite if it never does, NaN if unknown.

        It is the larger root of (b0 + b1 x - logit share)² = quantile² var(b0 + b1 x) for the log size x.
        """
        v, q2 = self.covariance, self.quantile**2
        gap = self.intercept - np.log(share / (1 - share))
        square = self.slope**2 - q2 * v[1, 1]
        if square <= 0:
            return np.inf
        half = self.slope * gap - q2 * v[0, 1]
        return _from_log((-half + np.sqrt(half**2 - square * (gap**2 - q2 * v[0, 0]))) / square)


@dataclass(frozen=True)
class Detection:
    """Detectable sizes, with reasons for missing ones.

    Attributes
    ----------
    a90, a90_95 : float
        Size that is detected in 90 % of recordings, and that size with 95 % confidence. NaN outside the tested sizes,
        where the curve does not apply.
    reasons : mapping
        From the name of each size that is NaN to the reason.
    curve : DetectionCurve or None
        None if no curve can be fitted.
    """

    a90: float
    a90_95: float
    reasons: Mapping[str, str]
    curve: DetectionCurve | None

    @property
    def reason(self) -> str:
        """All reasons in one line; empty if no size is missing."""
        return "; ".join(f"{name}: {why}" for name, why in self.reasons.items())


def detection(
    sizes: Float[np.ndarray, " row"], hits: Bool[np.ndarray, " row"], gears: np.ndarray, unit: str = ""
) -> Detection:
    """Fit a detection curve to hits and misses, with recordings of a gear as dependent.

    Parameters
    ----------
    sizes : array (row,)
        Fault sizes above 0.
    hits : array (row,) of bool
    gears : array (row,)
        Clusters of the covariance.
    unit : str
        Unit of the sizes in the reasons.
    """
    reason = _no_curve(sizes, hits, unit)
    if reason:
        return Detection(np.nan, np.nan, dict.fromkeys(NAMES, reason), None)
    curve = _fit(sizes, hits, gears)
    if curve.slope <= 0:
        falls = dict.fromkeys(NAMES, "not reached: detection does not grow with size")
        return Detection(np.nan, np.nan, falls, curve)
    found = dict(zip(NAMES, (curve.size_at(FOUND), curve.sure_size_at(FOUND)), strict=True))
    reasons = {name: why for name, value in found.items() if (why := _outside(value, sizes, unit))}
    given = {name: np.nan if name in reasons else value for name, value in found.items()}
    return Detection(**given, reasons=reasons, curve=curve)


def _no_curve(sizes: np.ndarray, hits: np.ndarray, unit: str) -> str:
    """Reason why no curve can be fitted: no misses, no hits, only one size, or hits and misses that do not overlap."""
    smallest, largest = f"{sizes.min():.3g}{unit}", f"{sizes.max():.3g}{unit}"
    if hits.all():
        return f"below the smallest size tried, {smallest}"
    if not hits.any():
        return f"not reached: never found up to the largest size tried, {largest}"
    if sizes.min() == sizes.max():
        return f"one size tried only, {smallest}: {100 * hits.mean():.0f} % found"
    if sizes[~hits].max() <= sizes[hits].min():
        return f"between {sizes[~hits].max():.3g} and {sizes[hits].min():.3g}{unit}: no miss is larger, no hit smaller"
    if sizes[hits].max() <= sizes[~hits].min():
        return "not reached: every hit is smaller than every miss"
    return ""


def _outside(value: float, sizes: np.ndarray, unit: str) -> str:
    if np.isnan(value):
        return f"fewer than {FEWEST_GEARS} gears, no confidence bound"
    if value < sizes.min():
        return f"below the smallest size tried, {sizes.min():.3g}{unit}"
    return f"not reached up to the largest size tried, {sizes.max():.3g}{unit}" if value > sizes.max() else ""


def _fit(sizes: np.ndarray, hits: np.ndarray, gears: np.ndarray) -> DetectionCurve:
    """Logistic regression on log size, with Student's quantile because gears are few."""
    from scipy.stats import t
    from statsmodels.genmod.families import Binomial
    from statsmodels.genmod.generalized_linear_model import GLM

    numbers = np.unique(gears, return_inverse=True)[1]
    count = int(numbers.max()) + 1
    terms = np.column_stack([np.ones(len(sizes)), np.log(sizes)])
    model = GLM(hits.astype(float), terms, family=Binomial())
    if count < FEWEST_GEARS:
        fitted, quantile = model.fit(), np.nan
    else:
        fitted = model.fit(cov_type="cluster", cov_kwds={"groups": numbers})
        quantile = float(t.ppf(SIDE, count - 1))
    intercept, slope = map(float, fitted.params)
    return DetectionCurve(intercept, slope, np.asarray(fitted.cov_params(), dtype=float), quantile)


def _from_log(logarithm: float) -> float:
    """Size from its logarithm, clipped where a flat curve would overflow."""
    return float(np.exp(np.clip(logarithm, -700, 700)))
