"""Lines and cells of a text file, within limits."""

import csv
import gzip
import re
from collections.abc import Iterator
from io import StringIO, TextIOBase, TextIOWrapper
from itertools import islice
from pathlib import Path
from typing import cast

from swgsim.tables.file_defect import FileDefect
from swgsim.tables.layout import Layout

# More characters than a row of a table has.
LONGEST_LINE = 100_000
CHUNK = 2**18
# Digits can be split in one way only. Otherwise a cell of many digits would take quadratic time.
NUMBER = re.compile(r"\s*[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?\s*", re.ASCII)


def number_of(cell: str, layout: Layout) -> float | None:
    """The number in a cell, read with the decimal sign and separators of a layout; None if it holds no number.

    >>> number_of("1.024,5", Layout(decimal=",", thousands=".")), number_of("1.024", Layout(decimal=","))
    (1024.5, None)
    """
    sign = re.escape(layout.thousands)
    if sign and re.fullmatch(rf"\s*[+-]?\d{{1,3}}({sign}\d{{3}})+({re.escape(layout.decimal)}\d*)?\s*", cell):
        cell = cell.replace(layout.thousands, "")
    if layout.decimal != "." and "." in cell:
        return None
    cell = cell.replace(layout.decimal, ".")
    return float(cell) if NUMBER.fullmatch(cell) else None


class TextStream(TextIOBase):
    """Text of a file for pandas, up to a number of characters in all and in one line."""

    def __init__(self, stream: TextIOBase, name: str, most: int) -> None:
        self._stream, self._name, self._left = stream, name, most
        self._row, self._line, self._waiting = 1, 0, ""

    def read(self, size: int | None = -1) -> str:
        """The next characters, at most a chunk."""
        text = self._stream.read(size if size and size > 0 else CHUNK)
        self._count(text)
        text, self._waiting = self._waiting + text, ""
        return text

    def readline(self, size: int = -1) -> str:  # type: ignore[override]
        """The next line."""
        text, self._waiting = self._waiting or self._stream.readline(LONGEST_LINE + 2), ""
        self._count(text)
        return text

    def put_back(self, text: str) -> None:
        """Have a text read again."""
        self._waiting = text

    def _count(self, text: str) -> None:
        """Raise a FileDefect at a limit."""
        lengths = [len(part) for part in text.split("\n")]
        lengths[0] += self._line
        for row, length in enumerate(lengths, self._row):
            if length > LONGEST_LINE:
                found = f"a line of more than {LONGEST_LINE} characters"
                raise FileDefect(self._name, found, "rows of a table", row)
        self._row, self._line, self._left = self._row + len(lengths) - 1, lengths[-1], self._left - len(text)
        if self._left < 0:
            expected = "less in a file of this size: write it less compressed, or split it"
            raise FileDefect(self._name, "more text than its size allows", expected, self._row)


def opened(path: Path, layout: Layout) -> TextIOBase:
    """A text file, also compressed by gzip, or the lines of it that the layout names."""
    if layout.lines is None:
        return _whole(path, layout)
    with _whole(path, layout) as stream:
        return StringIO("".join(islice(stream, layout.lines.start, layout.lines.stop)), newline="")


def _whole(path: Path, layout: Layout) -> TextIOWrapper:
    if path.suffix.lower() == ".gz":
        return cast(TextIOWrapper, gzip.open(path, "rt", encoding=layout.encoding, newline=""))
    return path.open(encoding=layout.encoding, newline="")


def cells_of(line: str, layout: Layout) -> list[str]:
    """Cells of one line, without quotes and blanks around them."""
    if layout.separator == " ":
        return [cell.strip('"') for cell in line.split()]
    return [cell.strip() for cell in next(csv.reader([line], delimiter=layout.separator, skipinitialspace=True), [])]


def is_comment(line: str, layout: Layout) -> bool:
    """Whether a line is a comment."""
    return bool(layout.comment) and line.lstrip().startswith(layout.comment)


def numbered_lines(path: Path, layout: Layout, first_row: int) -> Iterator[tuple[int, str]]:
    """Rows, as an editor counts, and their lines from a row on, without comments."""
    with opened(path, layout) as stream:
        for row, line in enumerate(iter(lambda: stream.readline(LONGEST_LINE + 2), ""), 1):
            if row >= first_row and not is_comment(line, layout):
                yield row, line
