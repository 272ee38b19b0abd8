"""The time of each sample: from a column, from two of them, from time stamps, or from the sampling rate."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float, Shaped

from swgsim.common.checks import require_integer, require_known
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.layout import LOST_READINGS
from swgsim.tables.measured_column import chosen_rows, column_name, filled, text
from swgsim.tables.plain_file import require_names
from swgsim.tables.units import FACTORS, known_unit

# The unit of a time stamp by ISO 8601; another form is given by its format, as strftime has it.
STAMP = "iso"
KEYS = ("column", "unit", "columns", "units", "file", "rows", "bits")
MOST_BITS = 48


@dataclass(frozen=True)
class Clock:
    """Columns whose sum is the time.

    Attributes
    ----------
    columns : tuple of str or int
    units : tuple of str
        Of each column: a unit of time, ``iso``, or a format such as ``%d.%m.%Y %H:%M:%S.%f``.
    file : str
        Which file of a run has them, by the group ``signal`` of the path.
    rows : tuple of (str or int, str)
        Columns of text, and what they say in the rows of this time.
    bits : int
        Of a counter that begins at 0 again when it is full; 0 for one that does not.
    """

    columns: tuple[str | int, ...]
    units: tuple[str, ...]
    file: str = ""
    rows: tuple[tuple[str | int, str], ...] = ()
    bits: int = 0

    def of(self, each: str) -> "Clock":
        """The clock of one of the recordings of a file."""
        return replace(self, columns=tuple(filled(column, each) for column in self.columns))

    @property
    def stamps(self) -> tuple[str | int, ...]:
        """Columns of text."""
        return tuple(column for column, unit in zip(self.columns, self.units, strict=True) if unit not in FACTORS["s"])

    def origin(self, read: Mapping[str | int, Shaped[np.ndarray, " time"]], file: str) -> tuple[Any, ...]:
        """What times count from: the first whole number or time stamp of each column, and 0 for other numbers.

        Parameters
        ----------
        read : mapping
            Column to array (time,).
        file : str
            Name of the file in messages.

        Raises
        ------
        FileDefect
            If a text is no time stamp of the format.
        """
        return tuple(_origin(self._times(read[column], unit, file, str(column))) for column, unit in self._pairs)

    def seconds(
        self, read: Mapping[str | int, Shaped[np.ndarray, " time"]], file: str, origin: tuple[Any, ...] | None = None
    ) -> Float[np.ndarray, " time"]:
        """Time of each sample [s]; parameters and errors as for :meth:`origin`.

        Whole numbers and time stamps count from the first sample, so that none loses digits, or from the origin of
        another clock of the same units.
        """
        origin = self.origin(read, file) if origin is None else origin
        parts = []
        for (column, unit), zero in zip(self._pairs, origin, strict=True):
            since = self._times(read[column], unit, file, str(column)) - zero
            stamps = unit not in FACTORS["s"]
            parts.append(since.dt.total_seconds() if stamps else since.astype(float) * FACTORS["s"][unit])
        return np.sum(parts, axis=0)

    @property
    def _pairs(self) -> list[tuple[str | int, str]]:
        return list(zip(self.columns, self.units, strict=True))

    def _times(self, values: Shaped[np.ndarray, " time"], unit: str, file: str, column: str) -> pd.Series:
        """Numbers, or time stamps from their texts; a counter that is full and a clock at midnight go on."""
        if unit in FACTORS["s"]:
            counts = pd.Series(values)
            if counts.dtype.kind == "u":
                counts = counts.astype("int64")  # differences have a sign
            return _onward(counts, 2**self.bits) if self.bits else counts
        stamps = _stamps(values, unit, file, column)
        dated = any(each == STAMP or re.search("%[cdDFjsx]", each) for each in self.units)
        return stamps if dated else _onward(stamps, pd.Timedelta(days=1))


def _onward(times: pd.Series, period: Any) -> pd.Series:
    """Times that begin anew after each period, without the jumps back: those by more than half of it."""
    return times + (times.ffill().diff() < -period / 2).cumsum() * period


def _stamps(values: Shaped[np.ndarray, " time"], unit: str, file: str, column: str) -> pd.Series:
    """Time stamps from their texts."""
    texts = pd.Series(values).astype(str)
    stamps = pd.to_datetime(texts, format="ISO8601" if unit == STAMP else unit, errors="coerce", utc=True)
    bad = np.flatnonzero(stamps.isna() & ~texts.isin(LOST_READINGS))
    if len(bad):
        expected = "a time stamp by ISO 8601, such as 2026-03-12T10:22:31.123" if unit == STAMP else f"one as {unit}"
        raise FileDefect(file, shown(texts[bad[0]]), f"{expected} (sample {bad[0] + 1})", column=column)
    return stamps


def _origin(times: pd.Series) -> Any:
    """The first time stamp or whole number."""
    if times.dtype.kind in "iu":
        return times.iloc[0] if len(times) else 0
    return times.dropna().iloc[0] if times.dtype.kind == "M" and times.notna().any() else 0.0


def read_clock(entry: Any) -> Clock:
    """The clock from plain data: ``column`` and ``unit``, or ``columns`` and ``units``.

    Raises
    ------
    ValueError
        If an entry is unknown or has no sense.
    """
    require_names("time", entry, KEYS)
    if ("columns" in entry) == ("column" in entry) or ("units" in entry) != ("columns" in entry):
        raise ValueError("time has neither column and unit nor columns and units: give one of the two pairs")
    columns = entry["columns"] if "columns" in entry else [entry["column"]]
    units = entry["units"] if "units" in entry else [entry.get("unit")]
    if not isinstance(columns, list) or not isinstance(units, list) or not 1 <= len(columns) == len(units) <= 3:
        raise ValueError(f"columns of time are {shown(columns)}, must be a list with as many units")
    found = tuple(known_unit(text("unit of time", unit)) for unit in units)
    for unit in found:
        if not re.search("%", unit):
            require_known("the unit of time", [unit], [*FACTORS["s"], STAMP])
    file = text("file of time", entry["file"]) if "file" in entry else ""
    bits = entry.get("bits", 0)
    require_integer("time", "bits", bits, 0, MOST_BITS)
    names = tuple(column_name("time", column) for column in columns)
    return Clock(names, found, file, chosen_rows("time", entry.get("rows", {})), bits)
