"""Defects of a text file that does not have the layout of its map, with the entry of the map that would help."""

import gzip
import re
from collections.abc import Sequence
from itertools import islice
from pathlib import Path

from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.layout import Layout
from swgsim.tables.text_stream import LONGEST_LINE, cells_of, numbered_lines

BYTE_ORDER = (b"\xff\xfe", b"\xfe\xff")
DECIMAL_COMMA = re.compile(r"\s*[+-]?\d+,\d+([eE][+-]?\d+)?\s*")
GROUPED = re.compile(r"\s*[+-]?\d{1,3}([.,' ]\d+)+([eE][+-]?\d+)?\s*")
# Bytes in which text has no zero.
PROBE = 4096
# Rows in which the names of the columns are looked for.
PREAMBLE = 200


def row_of(path: Path, layout: Layout, first_row: int, index: int) -> int:
    """Row of a file, as an editor counts, with the sample of an index from 0: comments are no samples."""
    return next(islice((row for row, _ in numbered_lines(path, layout, first_row)), index, None), first_row + index)


def require_separated(header: Sequence[str], name: str, layout: Layout, row: int) -> None:
    """Raise a FileDefect if the only cell of a header looks like many cells with another separator."""
    for sign, key in ((";", "';'"), ("\t", "tab")):
        if len(header) == 1 and sign in header[0] and sign != layout.separator:
            decimal = ", and decimal: ',' if its numbers have decimal commas" if sign == ";" else ""
            expected = f"cells separated by {shown(layout.separator)}; set separator: {key} in a map{decimal}"
            raise FileDefect(name, shown(header[0]), expected, row)


def with_header_row(defect: FileDefect, path: Path, layout: Layout, wanted: str | int) -> FileDefect:
    """The defect of a missing column, with the row that has its name if there is one."""
    for row, line in islice(numbered_lines(path, layout, 1), PREAMBLE):
        if wanted in cells_of(line[:LONGEST_LINE], layout) and row != defect.row:
            expected = f"{defect.expected}; row {row} has it: set header_row: {row} in a map"
            return FileDefect(defect.file, defect.found, expected, defect.row)
    return defect


def odd_row(path: Path, name: str, layout: Layout, width: int, first_row: int) -> FileDefect | None:
    """The first row with more cells than there are columns; empty ones at its end do not count."""
    for row, line in numbered_lines(path, layout, first_row):
        cells = cells_of(line[:LONGEST_LINE], layout)
        while len(cells) > width and not cells[-1]:
            cells.pop()
        if len(cells) > width:
            hint = "; if its numbers have decimal commas, set separator and decimal in a map"
            expected = f"{width}, as the row of names has{hint if layout.separator == ',' else ''}"
            return FileDefect(name, f"{len(cells)} cells", expected, row)
    return None


def number_expected(cell: str, layout: Layout, row: int, first_row: int) -> str:
    """What a cell in a row should hold, with the entry of the map that would help."""
    if layout.decimal == "." and DECIMAL_COMMA.fullmatch(cell):
        return "a number with a decimal point; set decimal: ',' in a map, or thousands: ','"
    if GROUPED.fullmatch(cell):
        return f"a number with {shown(layout.decimal)} as its decimal sign; set decimal or thousands in a map"
    if row == first_row:
        return f"a number; if this is a row of units or text, set first_row: {row + 1} in a map"
    return f"a number; if this is a lost reading, set lost: {{values: [{shown(cell.strip())}], leave_out: 1}} in a map"


def not_text(path: Path, name: str, layout: Layout) -> FileDefect:
    """The first row that is not text in the encoding."""
    with gzip.open(path) if path.suffix.lower() == ".gz" else path.open("rb") as raw:
        if raw.read(2) in BYTE_ORDER:
            found, expected = (
                "the mark of text in UTF-16",
                f"text in {layout.encoding}; set encoding: utf-16 in a map",
            )
            return FileDefect(name, found, expected, 1)
        raw.seek(0)
        if b"\0" in raw.read(PROBE):
            return FileDefect(name, "a binary file", "text, or a file that ends in .mat, .h5, .parquet, .tdms or .xlsx")
        raw.seek(0)
        row = next((row for row, line in enumerate(raw, 1) if not _is_text(line, layout)), 1)
    expected = f"text in {layout.encoding}; set encoding in a map, such as cp1252 for text from Windows"
    return FileDefect(name, "bytes that are not text", expected, row)


def _is_text(line: bytes, layout: Layout) -> bool:
    try:
        line.decode(layout.encoding)
    except UnicodeError:
        return False
    return True
