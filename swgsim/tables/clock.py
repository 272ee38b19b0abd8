"""The time of each sample: from a column, from two of them, from time stamps, or from the sampling rate."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float, Shaped

from swgsim.common.checks import require_known
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.measured_column import column_name, text
from swgsim.tables.plain_file import require_names
from swgsim.tables.units import FACTORS, known_unit

# The unit of a time stamp by ISO 8601; another form is given by its format, as strftime has it.
STAMP = "iso"
KEYS = ("column", "unit", "columns", "units", "file")


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
    """

    columns: tuple[str | int, ...]
    units: tuple[str, ...]
    file: str = ""

    @property
    def stamps(self) -> tuple[str | int, ...]:
        """Columns of text."""
        return tuple(column for column, unit in zip(self.columns, self.units, strict=True) if unit not in FACTORS["s"])

    def seconds(self, read: Mapping[str | int, Shaped[np.ndarray, " time"]], file: str) -> Float[np.ndarray, " time"]:
        """Time of each sample [s]. Whole numbers and time stamps count from the first sample: so none loses digits.

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
        parts = [
            _seconds(read[column], unit, file, str(column))
            for column, unit in zip(self.columns, self.units, strict=True)
        ]
        return np.sum(parts, axis=0)


def _seconds(values: Shaped[np.ndarray, " time"], unit: str, file: str, column: str) -> Float[np.ndarray, " time"]:
    if unit in FACTORS["s"]:
        if values.dtype.kind in "iu" and len(values):
            return (values - values[0]).astype(float) * FACTORS["s"][unit]
        return values.astype(float) * FACTORS["s"][unit]
    stamps = pd.to_datetime(pd.Series(values), format="ISO8601" if unit == STAMP else unit, errors="coerce", utc=True)
    bad = np.flatnonzero(stamps.isna() & (pd.Series(values).astype(str) != "nan"))
    if len(bad):
        expected = "a time stamp by ISO 8601, such as 2026-03-12T10:22:31.123" if unit == STAMP else f"one as {unit}"
        raise FileDefect(file, shown(str(values[bad[0]])), f"{expected} (sample {bad[0] + 1})", column=column)
    return (stamps - stamps.min()).dt.total_seconds().to_numpy(dtype=float)


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
    return Clock(tuple(column_name("time", column) for column in columns), found, file)
