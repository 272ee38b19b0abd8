"""Several tables below one another in a text file, each with the same row of names."""

from dataclasses import replace
from pathlib import Path

from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.layout import Layout
from swgsim.tables.limits import most_expanded
from swgsim.tables.text import start_of
from swgsim.tables.text_stream import TextStream, cells_of, number_of, opened


def tables_of(path: Path, name: str, layout: Layout) -> list[range]:
    """Rows of each table, from 0 and with its names: to the last row of numbers before the next names.

    Parameters
    ----------
    path : Path
    name : str
        Name of the file in messages.
    layout : Layout

    Raises
    ------
    FileDefect
        If the file has no row of names.
    """
    start = start_of(path, name, layout)
    if start.names_row is None:
        raise FileDefect(name, "columns without names", "a row of names before each table, where a map has 'each'")
    with opened(path, layout) as stream:
        rows = list(iter(TextStream(stream, name, most_expanded(path)).readline, ""))
    names = rows[start.names_row - 1].strip()
    begins = [place for place, row in enumerate(rows) if row.strip() == names]
    width = len(start.names)
    return [
        range(first, _after_numbers(rows, first, end, width, layout))
        for first, end in zip(begins, [*begins[1:], len(rows)], strict=True)
    ]


def _after_numbers(rows: list[str], first: int, end: int, width: int, layout: Layout) -> int:
    """The row after the last one that begins with a number, or has as many cells as names and a number in one.

    A row that was cut off begins with a number too: it is read, and its empty cells are lost readings.
    """
    while end > first + 1:
        cells = cells_of(rows[end - 1], layout)
        counted = cells if len(cells) >= width else cells[:1]
        if any(number_of(cell, layout) is not None for cell in counted):
            break
        end -= 1
    return end


def layout_of_table(path: Path, name: str, layout: Layout) -> Layout:
    """The layout that reads one table of a text file, whose number is the sheet.

    Raises
    ------
    FileDefect
        If the file has no table of this number.
    """
    tables = tables_of(path, name, replace(layout, sheet=""))
    if not layout.sheet.isdecimal() or not 1 <= int(layout.sheet) <= len(tables):
        found = f"{len(tables)} tables with the same row of names"
        raise FileDefect(name, found, f"a sheet from 1 to {len(tables)}, not {shown(layout.sheet)}")
    lines = tables[int(layout.sheet) - 1]
    header_row = layout.header_row or tables[0].start + 1
    first_row = None if layout.first_row is None else layout.first_row - header_row + 1
    return replace(layout, sheet="", header_row=1, first_row=first_row, lines=lines)
