"""What a reader of one format gives: a list of what the file holds, and functions that read an entry of it."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from itertools import islice
from re import split
from typing import NamedTuple, TypeVar

import numpy as np

from swgsim.tables.file_defect import FileDefect

# A file of a few kilobytes may list names without end, also in circles.
MOST_NAMES = 100_000

# Kinds that are numbers, in the words of NumPy and of MATLAB. A timestamp is an integer of nanoseconds.
NUMBERS = (
    "double", "single", "logical", "bool", "timestamp", "float16", "float32", "float64",
    *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)),
)  # fmt: skip
CONTAINERS = ("struct", "cell", "group")
# What MATLAB keeps in a form of its own, which only MATLAB reads.
OBJECTS = ("object", "opaque", "table", "timetable", "string", "datetime", "duration", "categorical")

T = TypeVar("T")


class Listed(NamedTuple):
    """One entry of a file.

    Parameters
    ----------
    name : str
    shape : tuple of int
    kind : str
        One of :data:`NUMBERS`, one of :data:`CONTAINERS`, whose members are listed after it, or what else it is.
    unit : str
        As the file says it; empty if it does not.
    base : str
        Its time base, equal for entries whose values belong together; empty if the format knows none.
    """

    name: str
    shape: tuple[int, ...]
    kind: str
    unit: str = ""
    base: str = ""


@dataclass(frozen=True)
class Contents:
    """An open file.

    Parameters
    ----------
    listed : sequence of Listed
    read : callable
        Values of the entry at a place of the list, in the shape and the numeric type of the file.
    time : callable, optional
        Times [s] of the entry at a place, which has a base; None for formats without time bases.
    others : mapping of str to int
        Further names of entries, such as ``group/channel``.
    ordered : bool
        Whether the order of the entries has a meaning, so that a number from 1 may be used for a name.
    """

    listed: Sequence[Listed]
    read: Callable[[int], np.ndarray]
    time: Callable[[int], np.ndarray] | None = None
    others: Mapping[str, int] = field(default_factory=dict)
    ordered: bool = False


def few(entries: Iterator[T], file: str) -> list[T]:
    """All entries, or a FileDefect if they are very many.

    >>> few(iter("ab"), "run1.mat")
    ['a', 'b']
    """
    found = list(islice(entries, MOST_NAMES + 1))
    if len(found) > MOST_NAMES:
        raise FileDefect(file, f"more than {MOST_NAMES} names", "fewer: save the numbers of one recording alone")
    return found


def meant(name: str, wanted: Sequence[str | int] | None) -> bool:
    """Whether a reference may lead into a struct or cell array; None stands for everything.

    >>> meant("Joint_state", ["time", "Joint_*.q[4]"])
    True
    """
    if wanted is None:
        return True
    return any(fnmatchcase(name, split(r"[.\[/]", each)[0]) for each in wanted if isinstance(each, str))


def short_names(groups: Sequence[str], names: Sequence[str]) -> list[str]:
    """The name alone where it is unique, else ``group/name``.

    >>> short_names(["a", "a", "b"], ["n", "T", "n"])
    ['a/n', 'T', 'b/n']
    """
    count = Counter(names)
    return [name if count[name] == 1 else f"{group}/{name}" for group, name in zip(groups, names, strict=True)]
