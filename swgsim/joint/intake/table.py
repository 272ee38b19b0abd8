"""Columns of one file by names or numbers: CSV, also compressed, Parquet and MATLAB."""

import gzip
import zlib
from array import array
from collections.abc import Iterator, Sequence
from io import TextIOWrapper
from itertools import chain
from pathlib import Path

import numpy as np
from jaxtyping import Float

from swgsim.recordings.files.facts import NUMBER
from swgsim.recordings.files.foreign import read_columns
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.limits import MOST_ROWS, most_expanded, require_readable

# Six joints with five signals of 20 characters need 600 characters.
LONGEST_LINE = 100_000

# Texts of recorders in place of a number; they lead to a finding.
NO_NUMBERS = ("nan", "inf", "-inf")

Columns = dict[str | int, Float[np.ndarray, " time"]]


def read_table(path: Path, name: str, wanted: Sequence[str | int], header: bool) -> Columns:
    """Columns of a file.

    Parameters
    ----------
    path : Path
        Its ending gives the format.
    name : str
        Name of the file in messages.
    wanted : sequence of str or int
        Names, or numbers from 1.
    header : bool
        Whether the first row of a CSV file has the names.

    Raises
    ------
    FileDefect
        If the file is damaged, is larger after decompression than :func:`limits.most_expanded` allows, or a column
        is missing or has no numbers.
    """
    require_readable(path)
    wanted = list(dict.fromkeys(wanted))
    if not path.name.lower().endswith((".csv", ".csv.gz")):
        if not header:
            raise FileDefect(name, f"a file that ends in {path.suffix}", "a CSV file, as only those have no header")
        named = read_columns(path, name, [str(column) for column in wanted])
        return {column: named[str(column)] for column in wanted}
    opened = gzip.open if path.suffix.lower() == ".gz" else open
    try:
        with opened(path, "rt", encoding="utf-8-sig", newline="") as stream:
            return _read_csv(stream, name, wanted, header, most_expanded(path))
    except (EOFError, gzip.BadGzipFile, zlib.error) as error:
        raise FileDefect(name, f"a damaged file ({error})", "a sound .csv.gz") from None
    except UnicodeDecodeError:
        raise FileDefect(name, "bytes that are no text", "a CSV file in UTF-8") from None


def _read_csv(stream: TextIOWrapper, name: str, wanted: list[str | int], header: bool, most: int) -> Columns:
    lines = _lines(stream, name, most, min(MOST_ROWS, most // (8 * len(wanted))))
    _, first = next(lines, (0, ""))
    if not first:
        raise FileDefect(name, "an empty file", "a row of numbers per sample", 1)
    if ";" in first or "\t" in first:
        raise FileDefect(name, shown(first.strip()), "commas between the columns, and points in the numbers", 1)
    cells = [cell.strip().strip('"') for cell in first.split(",")]
    places = _named(cells, name, wanted) if header else _numbered(cells, name, wanted)
    numbers = array("d")
    for row, line in chain([] if header else [(1, first)], lines):
        found = line.split(",")
        if len(found) != len(cells):
            raise FileDefect(name, f"{len(found)} cells", f"{len(cells)}, as the first row has", row)
        for place, column in zip(places, wanted, strict=True):
            cell = found[place].strip()
            if not NUMBER.fullmatch(cell) and cell.lower() not in NO_NUMBERS:
                raise FileDefect(name, shown(cell), "a number", row, str(column))
            numbers.append(float(cell))
    if not numbers:
        raise FileDefect(name, "a header without rows", "a row of numbers per sample", 2)
    table = np.frombuffer(numbers).reshape(-1, len(wanted))
    return {column: np.ascontiguousarray(table[:, i]) for i, column in enumerate(wanted)}


def _lines(stream: TextIOWrapper, name: str, most: int, most_rows: int) -> Iterator[tuple[int, str]]:
    """Lines with their numbers from 1, up to a limit of characters and rows; blank lines only at the end."""
    size = row = blank = 0
    while line := stream.readline(LONGEST_LINE + 1):
        row += 1
        size += len(line)
        if len(line) > LONGEST_LINE:
            raise FileDefect(name, f"a line of more than {LONGEST_LINE} characters", "a row of numbers", row)
        if size > most or row > most_rows:
            found = f"more than {most} characters or {most_rows} rows"
            raise FileDefect(name, found, "less in a file of this size: write it less compressed, or split it", row)
        if not line.strip():
            blank = blank or row
        elif blank:
            raise FileDefect(name, "a blank line", "a row of numbers", blank)
        else:
            yield row, line


def _named(cells: list[str], name: str, wanted: list[str | int]) -> list[int]:
    """Positions of the wanted columns by the names in the header."""
    for column in wanted:
        if cells.count(str(column)) != 1:
            found = f"{cells.count(str(column))} columns {shown(column)} among {', '.join(map(shown, cells[:20]))}"
            raise FileDefect(name, found, "one, as the source says", 1)
    return [cells.index(str(column)) for column in wanted]


def _numbered(cells: list[str], name: str, wanted: list[str | int]) -> list[int]:
    """Positions of the wanted columns by their numbers."""
    for column in wanted:
        if int(column) > len(cells):
            raise FileDefect(name, f"{len(cells)} columns", f"column {column}, as the source says", 1)
    return [int(column) - 1 for column in wanted]
