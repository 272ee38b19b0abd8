"""The numbers of one CSV file, column by column."""

from collections.abc import Iterator
from pathlib import Path
from typing import TextIO

import numpy as np
from jaxtyping import Float

from swgsim.recordings.files.facts import NUMBER
from swgsim.tables.file_defect import FIRST_ROW, FileDefect, shown
from swgsim.tables.limits import MOST_ROWS, require_readable

LONGEST_HEADER = 10_000
# A row has as many cells as the header, so a longer line is no row of a table.
LONGEST_LINE = 100_000


def read_table(path: Path, name: str) -> dict[str, Float[np.ndarray, " time"]]:
    """Every column of a CSV file with one header row, commas between cells and points in numbers.

    Parameters
    ----------
    path : Path
    name : str
        Name of the file in messages.

    Raises
    ------
    FileDefect
        If the file is empty or not text, a column has no name or that of another, or a cell is no number.
    """
    require_readable(path)
    try:
        with path.open(encoding="utf-8-sig") as stream:
            header = _header(stream, name)
            table = np.loadtxt(_lines(stream, name), delimiter=",", comments=None, ndmin=2)
    except FileDefect:
        raise
    except UnicodeDecodeError:
        raise _no_text(path, name) from None
    except ValueError as error:
        raise _first_bad_cell(path, name, header) or FileDefect(name, str(error), "numbers") from None
    if table.shape[1] != len(header):
        raise FileDefect(name, f"{table.shape[1]} cells", f"{len(header)}, as the header has", FIRST_ROW)
    return {column: np.ascontiguousarray(table[:, i]) for i, column in enumerate(header)}


def _header(stream: TextIO, name: str) -> list[str]:
    """The names of the columns."""
    line = stream.readline(LONGEST_HEADER)
    if not line.strip():
        raise FileDefect(name, "no header" if line else "an empty file", "a header such as t_s,phi_in_rad", 1)
    if ";" in line or "\t" in line:
        raise FileDefect(name, shown(line.strip()), "commas between the columns, and points in the numbers", 1)
    header = [cell.strip() for cell in line.split(",")]
    for number, column in enumerate(header, 1):
        if not column or column in header[: number - 1]:
            raise FileDefect(name, f"{shown(column)} as column {number}", "different names of all columns", 1)
    return header


def _lines(stream: TextIO, name: str) -> Iterator[str]:
    """The rows after the header; blank lines are allowed only at the end."""
    blank = 0
    rows = 0
    for row, line in enumerate(iter(lambda: stream.readline(LONGEST_LINE + 1), ""), FIRST_ROW):
        if len(line) > LONGEST_LINE:
            raise FileDefect(name, f"a line of more than {LONGEST_LINE} characters", "a row of numbers", row)
        if not line.strip():
            blank = blank or row
        elif blank:
            raise FileDefect(name, "a blank line", "a row of numbers", blank)
        elif rows == MOST_ROWS:
            raise FileDefect(name, "more rows", f"at most {MOST_ROWS}: split the recording", row)
        else:
            rows += 1
            yield line
    if not rows:
        raise FileDefect(name, "a header without rows", "a row of numbers per sample", FIRST_ROW)


def _no_text(path: Path, name: str) -> FileDefect:
    """The first row that is not text."""
    with path.open("rb") as raw:
        row = next(row for row, line in enumerate(raw, 1) if not _is_text(line))
    return FileDefect(name, "bytes that are not text", "a CSV file in UTF-8", row)


def _is_text(line: bytes) -> bool:
    """Whether bytes are UTF-8."""
    try:
        line.decode()
    except UnicodeDecodeError:
        return False
    return True


def _first_bad_cell(path: Path, name: str, header: list[str]) -> FileDefect | None:
    """The first row or cell that is not numbers; None if there is no such row."""
    with path.open(encoding="utf-8-sig") as stream:
        _header(stream, name)
        for row, line in enumerate(stream, FIRST_ROW):
            cells = line.rstrip("\n").split(",")
            if line.strip() and len(cells) != len(header):
                return FileDefect(name, f"{len(cells)} cells", f"{len(header)}, as the header has", row)
            for column, cell in zip(header, cells, strict=False):
                if line.strip() and not NUMBER.fullmatch(cell):
                    return FileDefect(name, shown(cell), "a finite number", row, column)
    return None
