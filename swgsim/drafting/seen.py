"""What a file shows: its columns with their names, their units and their first numbers."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Shaped

from swgsim.drafting.interleaved import interleaved_in
from swgsim.drafting.text_layout import TextLayout, text_layout
from swgsim.drafting.units import split_unit, unit_in
from swgsim.tables import binary
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.contents import NUMBERS
from swgsim.tables.layout import LOST_READINGS, Layout

# Rows that are looked at: minutes at the usual rates of joints, seconds at those of gauges.
MOST_ROWS = 100_000
# A matrix with more signals is a picture or a table of results.
MOST_SIGNALS = 64
# Beyond every unit, also nanoseconds since 1970; squares are still finite.
LARGEST = 1e20
# Values of a column that are shown.
SHOWN = 3


@dataclass(frozen=True, eq=False)
class SeenColumn:
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
    """

    column: str | int
    name: str
    unit: str
    values: Shaped[np.ndarray, " time"]
    file: str = ""
    lost: int = 0

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
        return ", ".join(f"{each:.6g}" if not self.is_text else str(each) for each in self.values[:SHOWN])

    @property
    def range(self) -> str:
        """Its smallest and largest number as text."""
        if self.is_text or self.is_empty:
            return ""
        return f"{np.nanmin(self.values):.5g} … {np.nanmax(self.values):.5g}"


@dataclass(frozen=True, eq=False)
class Seen:
    """One file, or the files of one run that are joined.

    Attributes
    ----------
    columns : tuple of SeenColumn
        Of numbers or time stamps, all of the same length.
    others : mapping of str to str
        Name of what else the file holds, and what it is.
    layout : Layout, optional
        Of text.
    interleaved : int
        How many signals follow one another in the only column.
    """

    columns: tuple[SeenColumn, ...]
    others: Mapping[str, str] = field(default_factory=dict)
    layout: Layout | None = None
    interleaved: int = 1

    @property
    def names(self) -> tuple[tuple[str | int, str], ...]:
        """What files that are read by the same map have in common."""
        return tuple((each.column, each.unit) for each in self.columns)


def see(path: Path, name: str) -> Seen:
    """Look at a file.

    Raises
    ------
    FileDefect
        If it holds no table of numbers.
    """
    if binary.is_binary(path):
        return _binary(path, name)
    found = text_layout(path, name)
    columns = tuple(_text_columns(path, found))
    numbers = tuple(each for each in columns if not each.is_empty)
    others = {str(each.column): "empty" for each in columns if each.is_empty}
    return Seen(numbers, others, found.layout)


def joined(seen: Mapping[str, Seen], name: str) -> Seen:
    """The files of one run, by their signal, as one; files with one column may have several signals in turn.

    Raises
    ------
    FileDefect
        If their lengths differ otherwise.
    """
    first = next(iter(seen.values()))
    lengths = {signal: len(each.columns[0].values) for signal, each in seen.items()}
    single = all(len(each.columns) == 1 for each in seen.values())
    turns = max(lengths.values()) // min(lengths.values())
    if single and turns == 1:
        turns = min(interleaved_in(each.columns[0].values) for each in seen.values())
    rows = max(lengths.values()) // turns
    if any(length not in (rows, rows * turns) for length in lengths.values()) or (turns > 1 and not single):
        raise FileDefect(name, f"files of one run with different lengths {lengths}", "as many rows in each")
    columns: list[SeenColumn] = []
    for signal, one in seen.items():
        whole = [replace(each, file=signal) for each in one.columns]
        columns += _in_turn(whole[0], turns) if turns > 1 and lengths[signal] == rows * turns else whole
    return Seen(tuple(columns), {}, first.layout, turns)


def _in_turn(column: SeenColumn, turns: int) -> Iterator[SeenColumn]:
    """The signals that follow one another in a column."""
    for number in range(turns):
        yield replace(
            column, column=number + 1, name=f"{column.file}[{number + 1}]", values=column.values[number::turns]
        )


def _text_columns(path: Path, found: TextLayout) -> Iterator[SeenColumn]:
    layout = found.layout
    table = pd.read_csv(
        path,
        sep=r"\s+" if layout.separator == " " else layout.separator,
        decimal=layout.decimal,
        encoding=layout.encoding,
        skiprows=found.first_row - 1,
        names=range(found.width),
        index_col=False,
        comment=layout.comment or None,
        na_values=list(LOST_READINGS),
        keep_default_na=False,
        skipinitialspace=True,
        on_bad_lines="skip",
        nrows=MOST_ROWS,
        low_memory=False,
    )
    # Empty rows at the end are none.
    table = table[: int(np.flatnonzero(table.notna().any(axis=1)).max(initial=-1)) + 1]
    for place in range(found.width):
        name = found.names[place] if place < len(found.names) else ""
        bare, unit = split_unit(name)
        values = table[place]
        if values.dtype.kind not in "iuf":
            numbers = pd.to_numeric(values.astype(str).str.replace(layout.decimal, ".", regex=False), errors="coerce")
            # A column is one of numbers if most of its cells are.
            values = numbers if 2 * numbers.notna().sum() > values.notna().sum() else values.astype(str)
        readings = _within(values.to_numpy())
        lost = int(pd.isna(readings).sum())
        column = name if name and found.names.count(name) == 1 else place + 1
        yield SeenColumn(column, bare, unit or unit_in(found.units[place]), readings, "", lost)


def _binary(path: Path, name: str) -> Seen:
    """The vectors and matrices of the length that most of them have."""
    listed = binary.listed(path, name)
    vectors: list[tuple[str, int, str]] = []
    others = {}
    for each in listed:
        sides = [length for length in each.shape if length != 1]
        if each.kind not in NUMBERS or len(sides) not in (1, 2) or (len(sides) == 2 and min(sides) > MOST_SIGNALS):
            others[each.name] = f"{each.kind} of shape {' x '.join(map(str, each.shape)) or '1'}"
        elif len(sides) == 1:
            vectors.append((each.name, sides[0], each.unit))
        else:
            vectors += [(f"{each.name}[{line + 1}]", max(sides), each.unit) for line in range(min(sides))]
    lengths = [length for _, length, _ in vectors]
    if not lengths:
        raise FileDefect(name, "no vectors or matrices of numbers", "a table of numbers")
    usual = max(set(lengths), key=lambda length: (lengths.count(length), length))
    others |= {column: f"{length} numbers" for column, length, _ in vectors if length != usual}
    wanted = [column for column, length, _ in vectors if length == usual]
    read = binary.read_columns(path, name, wanted)
    units = {column: unit for column, _, unit in vectors}
    columns = tuple(_binary_column(column, units[column], read[column][:MOST_ROWS]) for column in wanted)
    return Seen(tuple(each for each in columns if not each.is_empty), others)


def _binary_column(column: str, unit: str, values: np.ndarray) -> SeenColumn:
    bare, own = split_unit(column)
    values = _within(values)
    lost = 0 if values.dtype.kind in "iu" else int(np.isnan(values).sum())
    return SeenColumn(column, bare, unit_in(unit) or own, values, "", lost)


def _within(values: np.ndarray) -> np.ndarray:
    """Numbers that are too large for a measured value are lost readings."""
    if values.dtype.kind != "f":
        return values
    return np.where(np.abs(values) < LARGEST, values, np.nan)
