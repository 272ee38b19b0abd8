"""Columns of a sheet of a spreadsheet, by the layout that text has too."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Shaped

from swgsim.tables.column_names import column_place
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.formats.spreadsheet import cells
from swgsim.tables.layout import LOST_READINGS, Layout
from swgsim.tables.text import Columns, Start
from swgsim.tables.text_defects import number_expected
from swgsim.tables.text_stream import is_comment, number_of

Cell = float | int | str | bool | None


def read_spreadsheet(
    path: Path,
    name: str,
    wanted: Sequence[str | int],
    layout: Layout,
    texts: Sequence[str | int] = (),
    reader: LimitedReader | None = None,
) -> tuple[Columns, int]:
    """Columns of a sheet, and the row of the first sample; parameters and errors as for
    :func:`swgsim.tables.text.read_text`.
    """
    rows = cells(path, name, layout.sheet or None, reader)
    start = _start(rows, name, layout)
    numbered = [(row, line) for row, line in enumerate(rows, 1) if row >= start.row and not _is_comment(line, layout)]
    while numbered and not _filled(numbered[-1][1]):
        numbered.pop()
    found: Columns = {}
    for column in dict.fromkeys(wanted):
        place = column_place(column, start.names, name, start.names_row)
        values = [(row, line[place] if place < len(line) else None) for row, line in numbered]
        if column in texts:
            found[column] = np.array([str(value) for _, value in values], dtype=object)
        else:
            found[column] = _numbers(values, start.names[place], name, layout, start.row)
    return found, start.row


def _filled(line: Sequence[Cell]) -> bool:
    """Whether a row has a cell that is not empty."""
    return any(cell not in (None, "") for cell in line)


def _is_comment(line: Sequence[Cell], layout: Layout) -> bool:
    """Whether the first cell that is not empty begins with the sign of comments."""
    first = next((cell for cell in line if cell not in (None, "")), None)
    return isinstance(first, str) and is_comment(first, layout)


def _start(rows: Sequence[Sequence[Cell]], name: str, layout: Layout) -> Start:
    """Names of the columns and the first row of numbers."""
    filled = [row for row, line in enumerate(rows, 1) if _filled(line) and not _is_comment(line, layout)]
    if not filled:
        raise FileDefect(name, "an empty sheet", "a row of numbers for each sample")
    if not layout.named:
        first = layout.first_row or filled[0]
        return Start([str(number + 1) for number in range(max(map(len, rows)))], None, first, "")
    names_row = layout.header_row or filled[0]
    first = layout.first_row or names_row + 1
    if first > len(rows):
        raise FileDefect(name, f"{len(rows)} rows", "a row of numbers for each sample", first)
    return Start(["" if cell is None else str(cell).strip() for cell in rows[names_row - 1]], names_row, first, "")


def _numbers(
    values: Sequence[tuple[int, Cell]], column: str, name: str, layout: Layout, first_row: int
) -> Shaped[np.ndarray, " time"]:
    """The numbers of one column; texts that are numbers count as such."""
    found = []
    for row, value in values:
        lost = value is None or (isinstance(value, str) and value.strip() in (*LOST_READINGS, *layout.lost_values))
        number = number_of(value, layout) if isinstance(value, str) and not lost else value
        if isinstance(value, bool) or (number is None and not lost):
            raise FileDefect(name, shown(str(value)), number_expected(str(value), layout, row, first_row), row, column)
        found.append(np.nan if lost else number)
    return np.array(found)
