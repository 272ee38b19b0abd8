"""One column of a file: its name, its unit and its first numbers."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Shaped

# Rows that are looked at: minutes at the usual rates of joints, seconds at those of gauges.
MOST_ROWS = 100_000
# Beyond every unit, also nanoseconds since 1970; squares are still finite.
LARGEST_NUMBER = 1e20
# Values of a column that are shown.
SHOWN_VALUES = 3


@dataclass(frozen=True, eq=False)
class FileColumn:
    """One column.

    Attributes
    ----------
    column : str or int
        How a map names it.
    name : str
        As in the file, without its unit; empty if the file has no names.
    unit : str
        Unit of the file as the maps write it; empty if it says none.
    values : array (time,)
        Numbers with NaN for lost readings, or texts.
    file : str
        Its signal where each signal has a file of its own.
    lost : int
        Lost readings.
    time : str, int or None
        Column with times of its own; then the values are those at the times of all.
    """

    column: str | int
    name: str
    unit: str
    values: Shaped[np.ndarray, " time"]
    file: str = ""
    lost: int = 0
    time: str | int | None = None

    @property
    def is_text(self) -> bool:
        """Whether it holds texts."""
        return self.values.dtype.kind not in "iuf"

    @property
    def is_empty(self) -> bool:
        """Whether no reading of it is there."""
        return bool(pd.isna(self.values).all())

    @property
    def stands(self) -> bool:
        """Whether all its numbers are equal."""
        return not self.is_text and len(self.values) > 0 and bool(np.nanmax(self.values) == np.nanmin(self.values))

    @property
    def first(self) -> str:
        """Its first values as text."""
        return ", ".join(f"{each:.6g}" if not self.is_text else str(each) for each in self.values[:SHOWN_VALUES])

    @property
    def range(self) -> str:
        """Its smallest and largest number as text."""
        if self.is_text or self.is_empty:
            return ""
        return f"{np.nanmin(self.values):.5g} … {np.nanmax(self.values):.5g}"


def within(values: np.ndarray) -> np.ndarray:
    """Numbers that are too large for a measured value are lost readings."""
    if values.dtype.kind != "f":
        return values
    return np.where(np.abs(values) < LARGEST_NUMBER, values, np.nan)
