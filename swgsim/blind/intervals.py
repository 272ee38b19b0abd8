"""Figures with the interval that so many cases allow."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.stats import binomtest

from swgsim.common.seeds import generator

CONFIDENCE = 0.95
RESAMPLES = 2000


def rate(outcomes: Sequence[bool]) -> dict[str, Any]:
    """Share of true outcomes with Wilson's interval; None where there is no case.

    >>> rate([True, True, True, False])["value"]
    0.75
    """
    if not len(outcomes):
        return {"value": None, "low": None, "high": None, "count": 0}
    true, count = int(np.sum(outcomes)), len(outcomes)
    found = binomtest(true, count).proportion_ci(CONFIDENCE, method="wilson")
    return {"value": true / count, "low": float(found.low), "high": float(found.high), "count": count}


def median(values: Sequence[float]) -> dict[str, Any]:
    """Median with the interval of a bootstrap over the cases."""
    if not len(values):
        return {"value": None, "low": None, "high": None, "count": 0}
    rng = generator("bootstrap of a median", len(values))
    drawn = np.median(rng.choice(values, (RESAMPLES, len(values))), axis=1)
    low, high = np.quantile(drawn, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return {"value": float(np.median(values)), "low": float(low), "high": float(high), "count": len(values)}
