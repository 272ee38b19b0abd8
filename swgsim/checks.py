"""Checks of physical limits; every message names the value, the limit and so the remedy."""

from math import isfinite


def require(owner: str, name: str, value: float, low: float = float("-inf"), high: float = float("inf")) -> None:
    """Raise a ValueError unless ``value`` is finite and within [low, high]."""
    if not (isfinite(value) and low <= value <= high):
        raise ValueError(f"{name} of {owner} is {value}, must be a finite number from {low:g} to {high:g}")


def require_positive(owner: str, **values: float) -> None:
    """Raise a ValueError naming the first value that is not finite and above 0."""
    for name, value in values.items():
        if not (isfinite(value) and value > 0):
            raise ValueError(f"{name} of {owner} is {value}, must be a finite number above 0")
