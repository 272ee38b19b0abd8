"""One column of a file: where it is, and what its numbers mean."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np
from jaxtyping import Float, Shaped

from swgsim.common.checks import require, require_integer
from swgsim.tables.file_defect import shown
from swgsim.tables.plain_file import require_names
from swgsim.tables.units import known_unit, unit_factor

# No table has more columns; six joints of a UR10e have 31.
MOST_COLUMNS = 10_000
LONGEST_TEXT = 1000
# What the unit of a column may need.
OF_UNIT = ("per_revolution", "rated", "full_scale", "gauge_factor", "active_arms")
KEYS = ("column", "file", "unit", "factor", "offset", "inverted", "time", "rows", *OF_UNIT)
LARGEST_NUMBER = 1e15
# Stands for the name of one of the recordings of a file, in columns and sheet of a map.
EACH = "{each}"


@dataclass(frozen=True)
class MeasuredColumn:
    """A column.

    Attributes
    ----------
    quantity : str
        Name of the channel or signal.
    column : str or int
        Name in the file, path in a structure such as ``Joint_state.q[4]``, or number from 1.
    unit : str
        Unit in the file.
    gain, offset : float
        The quantity in its own unit is gain times number, plus offset.
    revolution : float
        What the numbers of an angle grow by in one revolution of what it measures.
    wraps : bool
        Whether an angle is wrapped to one revolution.
    file : str
        Which file of a run has it, by the group ``signal`` of the path; empty if each file has all columns.
    interleaved : int
        How many signals follow one another in the only column of the file; ``column`` is the number of this one.
    time : str, int or None
        Column of a time of its own, in the unit of the time of all: the signal is interpolated linearly to that.
    rows : tuple of (str or int, str)
        Columns of text, and what they say in the rows of this signal.
    """

    quantity: str
    column: str | int
    unit: str
    gain: float = 1.0
    offset: float = 0.0
    revolution: float = 2 * pi
    wraps: bool = False
    file: str = ""
    interleaved: int = 1
    time: str | int | None = None
    rows: tuple[tuple[str | int, str], ...] = ()

    def of(self, each: str) -> "MeasuredColumn":
        """The column in one of the recordings of a file."""
        time = None if self.time is None else filled(self.time, each)
        return replace(self, column=filled(self.column, each), time=time)

    def values(self, numbers: Shaped[np.ndarray, " time"]) -> Float[np.ndarray, " time"]:
        """The quantity from the numbers in the file; jumps of a wrapped angle are removed."""
        # Numbers that are not finite have a finding of their own.
        with np.errstate(over="ignore", invalid="ignore"):
            return self.unwrapped(np.asarray(numbers, dtype=float)) * self.gain + self.offset

    def unwrapped(self, numbers: Float[np.ndarray, " time"]) -> Float[np.ndarray, " time"]:
        """The numbers, without the jumps of an angle that wraps."""
        if not self.wraps or not np.isfinite(numbers).all():
            return numbers
        return np.unwrap(numbers, period=self.revolution)

    def wrapped(self, numbers: Float[np.ndarray, " time"]) -> Float[np.ndarray, " time"]:
        """The numbers, those of an angle that wraps within one revolution."""
        return numbers % self.revolution if self.wraps else numbers

    @property
    def place(self) -> str | int:
        """The column of the file that has the numbers."""
        return 1 if self.interleaved > 1 else self.column

    def own(self, numbers: Shaped[np.ndarray, " number"]) -> Shaped[np.ndarray, " time"]:
        """The numbers of this signal among those that follow one another in its column.

        What the last group lacks, because the recording was cut in it, is a lost reading.
        """
        if self.interleaved == 1:
            return numbers
        lost = -len(numbers) % self.interleaved
        if lost:
            numbers = np.append(numbers.astype(float), np.full(lost, np.nan))
        return numbers.reshape(-1, self.interleaved)[:, int(self.column) - 1]


def filled(column: str | int, each: str) -> str | int:
    """A column in one of the recordings of a file."""
    return column.replace(EACH, each) if isinstance(column, str) else column


def read_column(
    quantity: str, entry: Any, target: str, more: Sequence[str] = (), interleaved: int = 1
) -> MeasuredColumn:
    """A column from plain data.

    Parameters
    ----------
    quantity : str
    entry : mapping
        Entry of a map: ``column``, ``unit`` and more of :data:`KEYS`.
    target : str
        Unit of the quantity.
    more : sequence of str
        Further keys that the caller reads.
    interleaved : int
        As in :class:`MeasuredColumn`.

    Raises
    ------
    ValueError
        If an entry is unknown or has no sense.
    """
    require_names(quantity, entry, (*KEYS, *(("wraps",) if target == "rad" else ()), *more))
    column = column_name(quantity, entry.get("column"))
    if interleaved > 1:
        require_integer(quantity, "column", column, 1, interleaved)
    factor, offset = number("factor", entry, 1.0), number("offset", entry, 0.0)
    for name, value in (("factor", factor), ("offset", offset)):
        require(quantity, name, value, low=-LARGEST_NUMBER, high=LARGEST_NUMBER)
    if not factor:
        raise ValueError(f"factor of {quantity} is 0, must be another number")
    unit = known_unit(text(f"unit of {quantity}", entry.get("unit")))
    per_unit = unit_factor(quantity, target, unit, **{name: entry[name] for name in OF_UNIT if name in entry})
    sign = -1.0 if truth(f"inverted of {quantity}", entry.get("inverted", False)) else 1.0
    return MeasuredColumn(
        quantity,
        column,
        unit,
        sign * per_unit * (factor or 1.0),
        sign * per_unit * (offset or 0.0),
        abs(2 * pi / (per_unit * (factor or 1.0))),
        truth(f"wraps of {quantity}", entry.get("wraps", False)),
        text(f"file of {quantity}", entry["file"]) if "file" in entry else "",
        interleaved,
        column_name(f"time of {quantity}", entry["time"]) if "time" in entry else None,
        chosen_rows(quantity, entry.get("rows", {})),
    )


def chosen_rows(owner: str, entry: Any) -> tuple[tuple[str | int, str], ...]:
    """Columns of text, and what they say in the rows of a signal."""
    require_names(f"rows of {owner}", entry)
    return tuple((column, text(f"rows of {owner}", str(said))) for column, said in entry.items())


def column_name(owner: str, value: Any) -> str | int:
    """Name or number of a column.

    Raises
    ------
    ValueError
        If it is neither.
    """
    if isinstance(value, int) and not isinstance(value, bool):
        require_integer(owner, "column", value, 1, MOST_COLUMNS)
        return value
    return text(f"column of {owner}", value)


def text(name: str, value: Any) -> str:
    """A text of a map; a ValueError for anything else."""
    if not isinstance(value, str) or not value or not value.isprintable() or len(value) > LONGEST_TEXT:
        raise ValueError(f"{name} is {shown(value)}, must be printable text of at most {LONGEST_TEXT} characters")
    return value


def truth(name: str, value: Any) -> bool:
    """A switch of a map; a ValueError for anything else."""
    if not isinstance(value, bool):
        raise ValueError(f"{name} is {shown(value)}, must be true or false")
    return value


def number(name: str, entry: Mapping[str, Any], otherwise: float | None = None) -> float | None:
    """A number of a map; a ValueError for anything else."""
    value = entry.get(name, otherwise)
    if isinstance(value, str) and re.fullmatch(r"[+-]?\d+(\.\d*)?[eE][+-]?\d+", value):
        value = float(value)  # YAML takes 1e6 for a text
    if value is None:
        return None
    if not isinstance(value, int | float) or isinstance(value, bool):
        raise ValueError(f"{name} is {shown(value)}, must be a number")
    return float(value)
