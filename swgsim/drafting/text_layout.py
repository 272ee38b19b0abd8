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
from typing import NamedTuple

from swgsim.drafting.stamps import is_stamp
from swgsim.drafting.units import is_unit
from swgsim.drafting.vocabulary import WORDS
from swgsim.drafting.words import words_of
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.layout import LOST_READINGS, Layout
from swgsim.tables.limits import FEWEST_ROWS
from swgsim.tables.text_stream import NUMBER, cells_of

# What is looked at [byte], [rows]: preambles have at most some hundred rows.
BYTES_READ = 2**20
ROWS_READ = 400
MARKS = ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"))
# In the order in which they win if they fit equally well: a blank splits also what a tab separates.
SEPARATORS = ("\t", ";", ",", "|", " ")
COMMENTS = "#%"
ELSE = "docs/formats.md has the formats that are read, maps written by hand, and how other files are converted"
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


class Fit(NamedTuple):
    """What a separator and a decimal sign make of the lines.

    Attributes
    ----------
    rows : list of list of str
        Cells of all lines.
    digits : int
        Digits that belong to numbers of samples.
    width : int
        Cells of a sample.
    first, samples : int
        Place of the first sample, and number of samples.
    """

    rows: list[list[str]]
    digits: int
    width: int
    first: int
    samples: int

    @property
    def rank(self) -> tuple[int, int]:
        """Digits in numbers; where they are equal, the width if the row above the numbers has it too."""
        headed = self.first == 0 or len(self.rows[self.first - 1]) == self.width
        return self.digits, self.width if headed else 0


def text_layout(path: Path, name: str) -> TextLayout:
    """The layout of a text file.

    Raises
    ------
    FileDefect
        If no rows of numbers are found.
    """
    encoding, lines = _lines(path)
    return layout_of(lines, [each for each in product(SEPARATORS, ",.") if each[0] != each[1]], encoding, name)


def layout_of(lines: Sequence[str], choices: Sequence[tuple[str, str]], encoding: str, name: str) -> TextLayout:
    """The layout of lines by some choices of separator and decimal sign; errors as for :func:`text_layout`."""
    fits = {each: _fit(lines, *each) for each in choices}
    (separator, decimal), fit = max(fits.items(), key=lambda item: item[1].rank)
    if fit.samples < FEWEST_ROWS:
        found = f"{fit.samples} rows of numbers in the first {len(lines)} rows"
        raise FileDefect(name, found, f"a table of numbers; {ELSE}")
    rows, width, first = [*map(_unlabelled, fit.rows[: fit.first])], fit.width, fit.first
    names_at, units_at = _header(rows, width)
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
        head = raw.read(BYTES_READ + 1)
    encoding = next((name for mark, name in MARKS if head.startswith(mark)), "")
    whole = len(head) <= BYTES_READ
    if not encoding:
        try:
            codecs.getincrementaldecoder("utf-8")().decode(head, final=whole)
            encoding = "utf-8-sig"
        except UnicodeDecodeError:
            encoding = "cp1252"
    # An editor counts rows by these ends only; Python knows further ones.
    lines = re.split(r"\r\n|\n|\r", head.decode(encoding, errors="replace"))
    return encoding, (lines if whole else lines[:-1])[:ROWS_READ]


def _split(lines: Sequence[str], separator: str) -> list[list[str]]:
    """Cells of all lines; the sign of a comment is no part of the first one."""
    layout = Layout(separator=separator, decimal="." if separator == "," else ",")
    bare = (line.lstrip().lstrip(COMMENTS) if line.lstrip()[:1] in COMMENTS else line for line in lines)
    return [[cell.strip() for cell in cells_of(line, layout)] for line in bare]


def _fit(lines: Sequence[str], separator: str, decimal: str) -> Fit:
    """The table that a separator and a decimal sign make of the lines."""
    rows = _split(lines, separator)
    said = [line.lstrip()[:1] not in COMMENTS or not line.strip() for line in lines]
    digits = [[_digits(cell, decimal) for cell in row] if real else [] for row, real in zip(rows, said, strict=True)]
    by_width: Counter[int] = Counter()
    for row in digits:
        by_width[len(row)] += sum(max(each, 0) for each in row)
    width = max(by_width, key=by_width.__getitem__, default=0)
    table = [row for row in digits if len(row) == width]
    # Columns of numbers are those in which more cells are numbers than texts.
    numeric = [place for place in range(width) if sum((row[place] > 0) - (row[place] < 0) for row in table) > 0]
    samples = [
        place
        for place, row in enumerate(digits)
        if len(row) == width
        and numeric
        and min(row[each] for each in numeric) >= 0 < max(row[each] for each in numeric)
    ]
    if not samples:
        return Fit(rows, 0, width, 0, 0)
    return Fit(rows, sum(max(each, 0) for place in samples for each in digits[place]), width, samples[0], len(samples))


def _digits(cell: str, decimal: str) -> int:
    """Digits of a number or time stamp; 0 for a lost reading, -1 for another text."""
    number = cell.replace(",", ".") if decimal == "," and "." not in cell else cell
    if (NUMBER.fullmatch(number) and not (decimal == "," and "." in cell)) or is_stamp(cell):
        return len(DIGIT.findall(cell))
    return 0 if cell in LOST_READINGS else -1


def _header(above: Sequence[Sequence[str]], width: int) -> tuple[int | None, int | None]:
    """Places of the rows of names and of units: the last block of rows that are as wide as the numbers."""
    wide = [place for place, row in enumerate(above) if _filled(row) and abs(_filled(row) - width) <= 1]
    units = next((place for place in reversed(wide) if _are_units(above[place])), None)
    names = [
        place for place in wide if place != units and any(map(str.strip, above[place])) and _are_names(above[place])
    ]
    if units is not None and not any(place < units for place in names):
        units = None
    # The last row names most; of rows with labels, the first has the names that people gave.
    order = {place: (len(set(above[place])), place if above[place][0] else -place) for place in names}
    return (max(names, key=order.__getitem__) if names else None), units


def _unlabelled(row: list[str]) -> list[str]:
    """A row that says what it is before each of its cells, as scopes write it, without these labels.

    >>> _unlabelled(["Unit", "rad", "Unit", "A"])
    ['', 'rad', '', 'A']
    """
    label = row[0] if len(row) > 2 and len(row) % 2 == 0 and len(set(row[::2])) == 1 else ""
    says_time = set(words_of(label)[0]) & WORDS["time"]
    return row if not label or is_unit(label) or says_time else [c * (n % 2) for n, c in enumerate(row)]


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
