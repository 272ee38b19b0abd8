"""Numbers and intervals of reports; an unknown number is None."""

from math import isfinite
from typing import Any

import numpy as np

# Half width of a 95 % interval of a Gaussian, in standard deviations.
NORMAL = 1.96


def number(value: float) -> float | None:
    """A number for JSON: None if it is not finite."""
    return float(value) if isfinite(value) else None


def probability(value: float) -> str:
    """A small probability in words.

    >>> probability(0.012), probability(0.0)
    ('0.01', 'below 1e-300')
    """
    return f"{value:.1g}" if value > 1e-300 else "below 1e-300"


def estimate(value: float, deviation: float, unit: str, low: float = -np.inf, high: float = np.inf) -> dict[str, Any]:
    """A value with its 95 % interval, cut at the bounds of the parameter."""
    interval = [max(value - NORMAL * deviation, low), min(value + NORMAL * deviation, high)]
    return {"value": number(value), "ci95": [number(end) for end in interval], "unit": unit}


def significant(value: float | None, digits: int = 3) -> str:
    """A number as text with some significant digits.

    >>> significant(0.00012345), significant(None), significant(4810.8), significant(999.7)
    ('0.000123', 'not known', '4811', '1000')
    """
    if value is None:
        return "not known"
    return f"{value:.0f}" if 10**digits - 0.5 <= abs(value) < 1e6 else f"{value:.{digits}g}"
