"""Tables of text: CSV in all its forms, and what measuring amplifiers and controllers export, read by pandas."""

import gzip
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from jaxtyping import Shaped

from swgsim.tables.cell_lists import elements, list_and_number
from swgsim.tables.column_names import column_place
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.layout import LONGEST_PREAMBLE, LOST_READINGS, Layout
from swgsim.tables.limits import MOST_ROWS, most_expanded
from swgsim.tables.text_defects import (
    not_text,
    number_expected,
    odd_row,
    require_separated,
    row_of,
    with_header_row,
)
from swgsim.tables.text_stream import TextStream, cells_of, is_comment, number_of, opened

Columns = dict[str | int, Shaped[np.ndarray, " _"]]
NAMES_AGAIN = "a number; the row of names again: several tables in one file, see each and sheet in docs/formats.md"


class Start(NamedTuple):
    """What stands before the numbers.

    Attributes
    ----------
    names : list of str
        Names of the columns; their numbers where they have none.
    names_row : int, optional
        Their row.
    row : int
        Row of the first sample.
    line : str
        That row.
    """

    names: list[str]
    names_row: int | None
    row: int
    line: str


def read_text(
    path: Path, name: str, wanted: Sequence[str | int], layout: Layout, texts: Sequence[str | int] = ()
) -> Columns:
    """Columns of a text file, also compressed by gzip.

    Parameters
    ----------
    path : Path
    name : str
        Name of the file in messages.
    wanted : sequence of str or int
        Columns of numbers, as :func:`swgsim.tables.column_names.column_place` finds them, or ``position[3]`` for the
        third number of the lists in a column.
    layout : Layout
    texts : sequence of str or int
        Those that are read as text, such as time stamps.

    Returns
    -------
    dict
        Column to array (time,). Whole numbers are integers, lost readings are NaN.

    Raises
    ------
    FileDefect
        If the file is damaged or no text in the encoding, a column is missing, or a cell is no number.
    """
    if layout.separator == layout.decimal:
        signs = f"separator and decimal are both {shown(layout.decimal)}"
        raise FileDefect(name, signs, "two signs; set separator in a map")
    try:
        with opened(path, layout) as stream:
            rows = TextStream(stream, name, most_expanded(path))
            start = _start(rows, name, layout)
            parts = {column: list_and_number(column, start.names) for column in wanted}
            places = {column: _place(part, path, name, layout, start) for column, (part, _) in parts.items()}
            rows.put_back(start.line)
            table = _cells(rows, path, name, layout, start)
        found: Columns = {}
        for column, place in places.items():
            number = parts[column][1]
            cells = table[place] if number is None else elements(table[place], number, name, str(column), start.row)
            as_text = column in texts
            found[column] = (
                cells.astype(str).to_numpy(dtype=object) if as_text else _numbers(cells, path, name, layout, start)
            )
        return found
    except UnicodeError:
        raise not_text(path, name, layout) from None
    except (EOFError, gzip.BadGzipFile, zlib.error) as error:
        raise FileDefect(name, f"a damaged file ({error})", "a sound .gz") from None


def start_of(path: Path, name: str, layout: Layout) -> Start:
    """What stands before the numbers of a text file; errors as for :func:`read_text`."""
    try:
        with opened(path, layout) as stream:
            return _start(TextStream(stream, name, most_expanded(path)), name, layout)
    except UnicodeError:
        raise not_text(path, name, layout) from None


def _start(rows: TextStream, name: str, layout: Layout) -> Start:
    names: list[str] = []
    names_row = None
    for row in range(1, LONGEST_PREAMBLE):
        line = rows.readline()
        if not line:
            expected = "a row of numbers for each sample"
            raise FileDefect(name, "names without rows" if names else "an empty file", expected, row)
        if row == layout.header_row or (layout.header_row is None and not names and not _skipped(line, layout)):
            names_row, names = row, cells_of(line.lstrip().removeprefix(layout.comment), layout)
            require_separated(names, name, layout, row)
        elif row >= (layout.first_row or 1) and (names or not layout.named) and not is_comment(line, layout):
            numbers = [str(number) for number, _ in enumerate(cells_of(line, layout), 1)]
            return Start(names or numbers, names_row, row, line)
    raise FileDefect(name, f"{LONGEST_PREAMBLE} rows without numbers", "header_row and first_row of the map to be less")


def _skipped(line: str, layout: Layout) -> bool:
    """Whether a line before the names says nothing."""
    return is_comment(line, layout) or not line.strip()


def _place(column: str | int, path: Path, name: str, layout: Layout, start: Start) -> int:
    """Place of a column; the error for a missing one says which row has its name."""
    try:
        return column_place(column, start.names, name, start.names_row)
    except FileDefect as defect:
        raise with_header_row(defect, path, layout, column) from None


def _cells(rows: TextStream, path: Path, name: str, layout: Layout, start: Start) -> pd.DataFrame:
    """All cells from the first sample to the last."""
    width = max(len(start.names), len(cells_of(start.line, layout)))
    try:
        table = pd.read_csv(
            rows,
            sep=r"\s+" if layout.separator == " " else layout.separator,
            decimal=layout.decimal,
            names=range(width),
            comment=layout.comment or None,
            na_values=[*LOST_READINGS, *layout.lost_values],
            keep_default_na=False,
            skip_blank_lines=False,
            skipinitialspace=True,
            float_precision="round_trip",  # as exact as Python's own
            low_memory=False,  # one type for a whole column
            nrows=MOST_ROWS + 1,
        )
    except (pd.errors.ParserError, OverflowError) as error:
        odd = odd_row(path, name, layout, len(start.names), start.row)
        raise odd or FileDefect(name, str(error).strip(), "rows of a table", start.row) from None
    filled = table.notna()
    if (odd_cells := filled.iloc[:, len(start.names) :]).any(axis=None):
        odd = odd_row(path, name, layout, len(start.names), start.row)
        raise odd or FileDefect(name, f"{odd_cells.shape[1]} cells more", f"{len(start.names)}", start.row)
    used = np.flatnonzero(filled.any(axis=1))
    if len(used) > MOST_ROWS:
        raise FileDefect(name, "more rows", f"at most {MOST_ROWS}: split the recording")
    if not len(used):
        raise FileDefect(name, "rows without numbers", "a row of numbers for each sample", start.row)
    return table[: used[-1] + 1]


def _numbers(values: pd.Series, path: Path, name: str, layout: Layout, start: Start) -> Shaped[np.ndarray, " time"]:
    """The numbers of one column."""
    if values.dtype.kind in "iuf":
        return values.to_numpy()
    found = np.full(len(values), np.nan)
    for index in np.flatnonzero(values.notna()):
        number = number_of(str(values.iloc[index]), layout)
        if number is None:
            cell, column = str(values.iloc[index]), start.names[int(str(values.name))]
            row = row_of(path, layout, start.row, int(index))
            expected = NAMES_AGAIN if cell == column else number_expected(cell, layout, row, start.row)
            raise FileDefect(name, shown(cell), expected, row, column)
        found[index] = number
    return found
