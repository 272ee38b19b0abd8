"""Cells of a spreadsheet, by openpyxl, in the child process: values as they were saved, no formula is computed."""

from datetime import date, datetime, time, timedelta
from pathlib import Path

import openpyxl

from swgsim.tables.file_defect import FileDefect, shown

# A full sheet has 1,048,576 rows; ten columns of it are a gigabyte as cells.
MOST_CELLS = 10_000_000
MOST_SHEET_ROWS = 2**20

Cell = float | int | str | bool | None


def cells(path: Path, file: str, sheet: str | int | None) -> list[list[Cell]]:
    """Rows of a sheet, each up to its last cell that is not empty; an empty row is an empty list.

    Parameters
    ----------
    path : Path
    file : str
        Its name in messages.
    sheet : str or int, optional
        Its name, or its number from 1; by default the only one.
    """
    book = openpyxl.load_workbook(path, read_only=True, data_only=True, keep_links=False)
    try:
        page = book.worksheets[_number(sheet, [each.title for each in book.worksheets], file)]
        page.reset_dimensions()  # which other programs write wrongly, as A1
        rows: list[list[Cell]] = []
        count = 0
        for row in page.iter_rows(values_only=True):
            found = [_plain(value) for value in row]
            while found and found[-1] is None:
                found.pop()
            count += len(found)
            rows.append(found)
            if count > MOST_CELLS or len(rows) > MOST_SHEET_ROWS:
                expected = f"at most {MOST_CELLS} cells in {MOST_SHEET_ROWS} rows: save the sheet as CSV"
                raise FileDefect(file, "more cells or rows", expected, len(rows))
        while rows and not rows[-1]:
            rows.pop()
        return rows
    finally:
        book.close()


def sheets(path: Path) -> list[str]:
    """Names of the sheets."""
    book = openpyxl.load_workbook(path, read_only=True, data_only=True, keep_links=False)
    try:
        return [each.title for each in book.worksheets]
    finally:
        book.close()


def _number(sheet: str | int | None, names: list[str], file: str) -> int:
    """Place of a sheet, from 0."""
    if sheet is None and len(names) == 1:
        return 0
    if isinstance(sheet, int) and 1 <= sheet <= len(names):
        return sheet - 1
    if sheet in names:
        return names.index(str(sheet))
    raise FileDefect(
        file, f"the sheets {', '.join(map(shown, names[:20])) or 'none'}", "one of them: set sheet in a map"
    )


def _plain(value: object) -> Cell:
    """A cell as a plain value: a date is a text as ISO 8601 has it; a duration or a time of day is in seconds."""
    if isinstance(value, time):
        return value.hour * 3600 + value.minute * 60 + value.second + value.microsecond * 1e-6
    if isinstance(value, datetime | date):
        return value.isoformat()
    if isinstance(value, timedelta):
        return value.total_seconds()
    return value if isinstance(value, float | int | str | None) else str(value)
