"""Checks of values against limits; every message names the value and the limit."""

from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from math import isfinite
from numbers import Integral, Real
from reprlib import Repr
from typing import Any

# Names that the message about an unknown choice lists at most.
LISTED = 20
# Short text of a value from a file; a nested value could fill the memory as text.
_SHORT = Repr()
_SHORT.maxstring = _SHORT.maxother = _SHORT.maxlong = 200


def require(owner: str, name: str, value: Any, low: float = float("-inf"), high: float = float("inf")) -> None:
    """Raise a ValueError unless ``value`` is a finite number within [low, high]."""
    if type(value) is float and low <= value <= high and value - value == 0:  # the usual case, several times as fast
        return
    if not (_is_number(value) and isfinite(value) and low <= value <= high):
        raise ValueError(f"{name} of {owner} is {_SHORT.repr(value)}, must be a finite number from {low:g} to {high:g}")


def require_positive(owner: str, **values: Any) -> None:
    """Raise a ValueError naming the first value that is not a finite number above 0."""
    for name, value in values.items():
        if not (_is_number(value) and isfinite(value) and value > 0):
            raise ValueError(f"{name} of {owner} is {_SHORT.repr(value)}, must be a finite number above 0")


def require_integer(owner: str, name: str, value: Any, low: int, high: int) -> None:
    """Raise a ValueError unless ``value`` is an integer within [low, high]."""
    if not (isinstance(value, Integral) and not isinstance(value, bool) and low <= int(value) <= high):
        raise ValueError(f"{name} of {owner} is {_SHORT.repr(value)}, must be an integer from {low} to {high}")


def require_one_of(owner: str, name: str, value: Any, among: Sequence[float]) -> None:
    """Raise a ValueError unless ``value`` is one of a list of numbers."""
    if not (_is_number(value) and value in among):
        listed = ", ".join(f"{each:g}" for each in among)
        raise ValueError(f"{name} of {owner} is {_SHORT.repr(value)}, must be one of {listed}")


def require_range(owner: str, name: str, value: Any, low: float, high: float) -> None:
    """Raise a ValueError unless ``value`` is a pair of numbers in ascending order within [low, high]."""
    if not isinstance(value, tuple) or len(value) != 2 or not all(_is_number(v) for v in value):
        raise ValueError(f"{name} of {owner} is {_SHORT.repr(value)}, must be a pair of numbers: from, to")
    if not low <= value[0] <= value[1] <= high:
        raise ValueError(f"{name} of {owner} is {_SHORT.repr(value)}, must ascend and stay from {low:g} to {high:g}")


def require_known(owner: str, given: Iterable[str], known: Iterable[str]) -> None:
    """Raise a ValueError that names the first of ``given`` that is not known, and the choices, nearest names first.

    Parameters
    ----------
    owner : str
        What the choice belongs to, for the message.
    given, known : iterable of str
    """
    known = list(known)
    for name in given:
        if name not in known:
            near = nearest(name, known)
            choices = [*near, *(each for each in known if each not in near)]
            more = f" and {len(choices) - LISTED} more" if len(choices) > LISTED else ""
            raise ValueError(f"unknown choice {name!r} of {owner}; choose from {', '.join(choices[:LISTED])}{more}")


def nearest(name: str, known: Iterable[str]) -> list[str]:
    """Known names that are spelt nearly like an unknown one, nearest first; three at most.

    >>> nearest("ecentric_wave_generator", ["coning", "eccentric_wave_generator"])
    ['eccentric_wave_generator']
    """
    return get_close_matches(str(name), [str(each) for each in known], cutoff=0.8)


def _is_number(value: Any) -> bool:
    """Whether a value is a real number that a float can hold; integers of Python have no limit."""
    if type(value) is float:  # the usual case; the check below takes ten times as long
        return True
    if not isinstance(value, Real) or isinstance(value, bool):
        return False
    try:
        float(value)
    except OverflowError:
        return False
    return True
