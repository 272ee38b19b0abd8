"""The layout of a text file, by looking at its first rows.

Each pair of separator and decimal sign splits the rows into cells. The right pair is that by which most digits belong
to numbers in rows of the same width: a wrong separator leaves cells that are no numbers, and a wrong decimal sign too.
"""

import codecs
import gzip
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from swgsim.drafting.stamps import is_stamp
from swgsim.drafting.units import is_unit
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.layout import LOST_READINGS, Layout
from swgsim.tables.text_stream import NUMBER, cells_of

# What is looked at [byte], [rows]: preambles have at most a few hundred rows.
LOOKED = 2**20
ROWS = 1000
MARKS = ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"))
# In the order in which they win if they fit equally well: a blank splits also what a tab separates.
SEPARATORS = ("\t", ";", ",", "|", " ")
COMMENTS = "#%"
DIGIT = re.compile(r"\d")


@dataclass(frozen=True)
class TextLayout:
    """What was seen of a text file.

    Attributes
    ----------
    layout : Layout
    names : tuple of str
        Of the columns; empty for a file without names.
    units : tuple of str
        Of the row of units; empty texts where there is none.
    width : int
    first_row : int
        First row of numbers.
    """

    layout: Layout
    names: tuple[str, ...]
    units: tuple[str, ...]
    width: int
    first_row: int


def text_layout(path: Path, name: str) -> TextLayout:
    """The layout of a text file.

    Raises
    ------
    FileDefect
        If no rows of numbers are found.
    """
    encoding, lines = _lines(path)
    choices = [each for each in product(SEPARATORS, ",.") if each[0] != each[1]]
    fits = {choice: _fit(lines, *choice) for choice in choices}
    separator, decimal = max(choices, key=lambda choice: fits[choice][:2])
    digits, _, width = fits[separator, decimal]
    if not digits:
        found = f"no rows of numbers in the first {len(lines)} rows"
        raise FileDefect(name, found, "a table of numbers; if it has one, write the map by hand (docs/formats.md)")
    rows = [_cells(line, separator) for line in lines]
    first = _first(rows, decimal, width)
    names_at, units_at = _header(rows[:first], width)
    comment = next((line.lstrip()[0] for line in lines if line.lstrip()[:1] and line.lstrip()[0] in COMMENTS), "")
    names = tuple(rows[names_at][:width]) if names_at is not None else ()
    plain = _plain_header(lines, comment)
    layout = Layout(
        separator=separator,
        decimal=decimal,
        encoding=encoding,
        header_row=0 if names_at is None else None if names_at == plain else names_at + 1,
        first_row=None if first == (0 if names_at is None else names_at + 1) else first + 1,
        comment=comment,
    )
    units = tuple(rows[units_at][:width]) if units_at is not None else ()
    return TextLayout(layout, names, units + ("",) * (width - len(units)), width, first + 1)


def _lines(path: Path) -> tuple[str, list[str]]:
    """Encoding and first lines of a file; the last one is cut off where the file goes on."""
    with gzip.open(path) if path.suffix.lower() == ".gz" else path.open("rb") as raw:
        head = raw.read(LOOKED + 1)
    encoding = next((name for mark, name in MARKS if head.startswith(mark)), "")
    whole = len(head) <= LOOKED
    if not encoding:
        try:
            codecs.getincrementaldecoder("utf-8")().decode(head, final=whole)
            encoding = "utf-8-sig"
        except UnicodeDecodeError:
            encoding = "cp1252"
    lines = head.decode(encoding, errors="replace").splitlines()
    return encoding, (lines if whole else lines[:-1])[:ROWS]


def _cells(line: str, separator: str) -> list[str]:
    """Cells of a line; the sign of a comment is no part of the first one."""
    text = line.lstrip().lstrip(COMMENTS) if line.lstrip()[:1] in COMMENTS else line
    return [
        cell.strip() for cell in cells_of(text, Layout(separator=separator, decimal="." if separator == "," else ","))
    ]


def _fit(lines: Sequence[str], separator: str, decimal: str) -> tuple[int, int, int]:
    """Digits in the numbers of the table, its width if the row above has it too, and its width."""
    rows = [[] if line.lstrip()[:1] in COMMENTS else _cells(line, separator) for line in lines]
    digits: Counter[int] = Counter()
    for row in rows:
        digits[len(row)] += _digits(row, decimal)
    width = digits.most_common(1)[0][0] if digits else 0
    numeric = _numeric(rows, decimal, width)
    places = [place for place, row in enumerate(rows) if _is_sample(row, numeric, decimal, width)]
    count = sum(_digits(rows[place], decimal) for place in places)
    above = places and (places[0] == 0 or len(_cells(lines[places[0] - 1], separator)) == width)
    return count, width if above else 0, width


def _digits(row: Sequence[str], decimal: str) -> int:
    """Digits of a row that belong to numbers."""
    return sum(len(DIGIT.findall(cell)) for cell in row if _is_number(cell, decimal))


def _numeric(rows: Sequence[Sequence[str]], decimal: str, width: int) -> list[int]:
    """Places of the cells that are numbers in most rows of a width."""
    table = [row for row in rows if len(row) == width]
    return [
        place
        for place in range(width)
        if 2 * sum(_is_number(row[place], decimal) for row in table) > sum(bool(row[place]) for row in table)
    ]


def _is_sample(row: Sequence[str], numeric: Sequence[int], decimal: str, width: int) -> bool:
    """Whether a row has numbers, or lost readings, wherever most rows have numbers."""
    known = [row[place] for place in numeric if row[place]] if len(row) == width else []
    return any(_is_number(cell, decimal) for cell in known) and all(
        _is_number(cell, decimal) or cell in LOST_READINGS for cell in known
    )


def _is_number(cell: str, decimal: str) -> bool:
    """Whether a cell is a number or a time stamp."""
    if decimal == ",":
        return ("." not in cell and bool(NUMBER.fullmatch(cell.replace(",", ".")))) or is_stamp(cell)
    return bool(NUMBER.fullmatch(cell)) or is_stamp(cell)


def _first(rows: Sequence[Sequence[str]], decimal: str, width: int) -> int:
    """Place of the first sample."""
    numeric = _numeric(rows, decimal, width)
    return next(place for place, row in enumerate(rows) if _is_sample(row, numeric, decimal, width))


def _header(above: Sequence[Sequence[str]], width: int) -> tuple[int | None, int | None]:
    """Places of the rows of names and of units: the last block of rows that are as wide as the numbers."""
    wide = [place for place, row in enumerate(above) if _filled(row) and abs(_filled(row) - width) <= 1]
    units = next((place for place in reversed(wide) if _are_units(above[place])), None)
    names = [
        place for place in wide if place != units and any(map(str.strip, above[place])) and _are_names(above[place])
    ]
    if units is not None and not any(place < units for place in names):
        units = None
    return (max(names, key=lambda place: (len(set(above[place])), place)) if names else None), units


def _filled(row: Sequence[str]) -> int:
    """Number of cells up to the last that is not empty."""
    return max((place for place, cell in enumerate(row, 1) if cell), default=0)


def _are_units(row: Sequence[str]) -> bool:
    """Whether most cells of a row are units."""
    cells = [cell for cell in row if cell]
    return bool(cells) and 2 * sum(map(is_unit, cells)) > len(cells)


def _are_names(row: Sequence[str]) -> bool:
    """Whether most cells of a row are words."""
    cells = [cell for cell in row if cell]
    return 2 * sum(not NUMBER.fullmatch(cell) and not is_stamp(cell) for cell in cells) > len(cells)


def _plain_header(lines: Sequence[str], comment: str) -> int | None:
    """Place of the row that is taken for the names if a map says nothing."""
    said = (place for place, line in enumerate(lines) if line.strip() and not (comment and line.lstrip()[0] == comment))
    return next(said, None)
