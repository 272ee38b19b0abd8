"""Columns of binary files, and the cells of spreadsheets as lines of text."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from swgsim.drafting.file_column import MOST_ROWS, FileColumn, within
from swgsim.drafting.units import split_unit, unit_in
from swgsim.tables import binary
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.contents import NUMBERS
from swgsim.tables.formats.spreadsheet import cells

# A matrix with more signals is a picture or a table of results.
MOST_SIGNALS = 64
# Separator and decimal sign of the lines of a spreadsheet.
SHEET = ("\t", ".")


def binary_columns(path: Path, name: str) -> tuple[tuple[FileColumn, ...], Mapping[str, str]]:
    """The vectors and matrices of the length and the time base that most of them have, and what else there is.

    Raises
    ------
    FileDefect
        If the file holds no vectors of numbers.
    """
    vectors: list[tuple[str, tuple[int, str], str]] = []
    others = {}
    for each in binary.listed(path, name):
        sides = [length for length in each.shape if length != 1]
        if each.kind not in NUMBERS or len(sides) not in (1, 2) or (len(sides) == 2 and min(sides) > MOST_SIGNALS):
            others[each.name] = f"{each.kind} of shape {' x '.join(map(str, each.shape)) or '1'}"
        elif len(sides) == 1:
            vectors.append((each.name, (sides[0], each.base), each.unit))
        else:
            lines = [f"{each.name}[{line}]" for line in range(1, min(sides) + 1)]
            vectors += [(line, (max(sides), each.base), each.unit) for line in lines]
    if not vectors:
        raise FileDefect(name, "no vectors or matrices of numbers", "a table of numbers")
    kinds = [kind for _, kind, _ in vectors]
    usual = max(set(kinds), key=lambda kind: (kinds.count(kind), kind))
    others |= {column: f"{kind[0]} numbers {kind[1]}".strip() for column, kind, _ in vectors if kind != usual}
    units = {column: unit for column, kind, unit in vectors if kind == usual}
    if usual[1]:
        units = {binary.TIME: "s"} | units
    read = binary.read_columns(path, name, list(units))
    columns = (_column(column, unit, within(read[column][:MOST_ROWS])) for column, unit in units.items())
    return tuple(each for each in columns if not each.is_empty), others


def _column(column: str, unit: str, values: np.ndarray) -> FileColumn:
    bare, own = split_unit(column)
    lost = 0 if values.dtype.kind in "iu" else int(np.isnan(values).sum())
    return FileColumn(column, bare, unit_in(unit) or own, values, "", lost)


def sheet_lines(path: Path, name: str) -> list[str]:
    """Rows of the first sheet of a spreadsheet as lines, all of the same number of cells."""
    rows = cells(path, name)
    width = max(map(len, rows), default=0)
    texts = [["" if cell is None else " ".join(str(cell).split()) for cell in row] for row in rows]
    return ["\t".join([*row, *[""] * (width - len(row))]) for row in texts]
