"""How a table is written in a file: separator, decimal sign, encoding, and the rows of names and of numbers."""

import codecs
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from swgsim.common.checks import require_integer, require_known
from swgsim.tables.file_defect import shown
from swgsim.tables.measured_column import chosen_rows
from swgsim.tables.plain_file import require_names

# Names of separators that are hard to see in a YAML file.
SEPARATORS = {"tab": "\t", "blanks": " "}
# Types of bare numbers as NumPy names them, with < where the least byte comes first.
RAW = tuple(f"{order}{kind}" for kind in ("i2", "i4", "u2", "f4", "f8") for order in ("<", ">"))
# What recorders and spreadsheets write in place of a number that they did not get.
LOST_READINGS = ("", "nan", "NaN", "NAN", "NA", "N/A", "#N/A", "null", "NULL", "None", "-", "--", "1.#QNAN", "-1.#IND")
LONGEST_PREAMBLE = 10_000
MOST_LOST = 1_000_000
LEAVE_OUT = "leave_out"
# A bus loses single readings. More than a hundredth is no accident, and the gaps would bias the fits.
FEW = 0.01


@dataclass(frozen=True)
class Layout:
    """Layout of a table.

    Attributes
    ----------
    separator : str
        One character between the cells. A blank stands for any number of blanks and tabs.
    decimal : str
        Decimal sign, ``.`` or ``,``.
    thousands : str
        Sign between groups of three digits; none if empty.
    encoding : str
        Name of the encoding of the text, as Python knows it.
    header_row : int, optional
        Row of the names of the columns, as an editor counts; by default the first row that is no comment. It is 0 for a
        file without names, whose columns have numbers from 1.
    first_row : int, optional
        First row of numbers; by default that after the names.
    comment : str
        Character that begins a comment; none if empty.
    sheet : str
        Sheet of a spreadsheet; the only one if empty. Of a text file that repeats its row of names: the number of a
        table, from 1.
    rows : tuple of (str or int, str)
        Columns of text, and what they say in the rows that are read; all rows if empty.
    lost_values : tuple of str
        Texts that stand for a lost reading, besides :data:`LOST_READINGS`.
    lost_rows : int or float
        How many rows with a lost reading may be left out: a number, or a share of all rows below 1.
    raw : str
        Type of the numbers of a file that has nothing else, as NumPy names it; empty for other files.
    lines : range, optional
        Rows of a text file, from 0, that are read as if they were the file.

    Raises
    ------
    ValueError
        If a value is unknown or contradicts another one.
    """

    separator: str = ","
    decimal: str = "."
    thousands: str = ""
    encoding: str = "utf-8-sig"
    header_row: int | None = None
    first_row: int | None = None
    comment: str = ""
    sheet: str = ""
    rows: tuple[tuple[str | int, str], ...] = ()
    lost_values: tuple[str, ...] = ()
    lost_rows: float = 0
    raw: str = ""
    lines: range | None = None

    def __post_init__(self) -> None:
        require_known("decimal signs", [self.decimal], [".", ","])
        if len(self.separator) != 1 or self.separator in '"\r\n':
            names = ", ".join(SEPARATORS)
            raise ValueError(f"separator is {shown(self.separator)}, must be one character, or one of {names}")
        if len(self.thousands) > 1 or (self.thousands and self.thousands in self.decimal + "+-0123456789"):
            raise ValueError(f"thousands is {shown(self.thousands)}, must be a sign such as '.' and not the decimal")
        if len(self.comment) > 1:
            raise ValueError(f"comment is {shown(self.comment)}, must be one character, such as '#'")
        require_known("raw", [self.raw] if self.raw else [], RAW)
        try:
            codecs.lookup(self.encoding)
        except LookupError:
            raise ValueError(f"encoding is {shown(self.encoding)}, must be one such as utf-8, utf-16, cp1252") from None
        for name, row, least in (("header_row", self.header_row, 0), ("first_row", self.first_row, 1)):
            if row is not None:
                require_integer("the layout", name, row, least, LONGEST_PREAMBLE)
        if self.header_row and self.first_row and self.first_row <= self.header_row:
            raise ValueError(f"first_row is {self.first_row}, must be after header_row {self.header_row}")

    @property
    def named(self) -> bool:
        """Whether the columns have names."""
        return self.header_row != 0


KEYS = (
    "separator",
    "decimal",
    "thousands",
    "encoding",
    "header",
    "header_row",
    "first_row",
    "comment",
    "sheet",
    "rows",
    "lost",
    "raw",
)


def read_layout(config: Mapping[str, Any]) -> Layout:
    """The layout from the entries of a map; all others are ignored.

    Raises
    ------
    ValueError
        If an entry has no sense.
    """
    given = {key: config[key] for key in KEYS if key in config}
    for key in ("separator", "decimal", "thousands", "encoding", "comment", "sheet", "raw"):
        if not isinstance(given.get(key, ""), str):
            raise ValueError(f"{key} is {shown(given[key])}, must be a text in quotes")
    header = given.pop("header", True)
    if not isinstance(header, bool):
        raise ValueError(f"header is {shown(header)}, must be true or false; the row belongs to header_row")
    if not header:
        if given.get("header_row"):
            raise ValueError(f"header is false, and header_row is {given['header_row']}: keep one of them")
        given["header_row"] = 0
    if given.get("raw"):
        given["header_row"] = 0
    if "separator" in given:
        given["separator"] = SEPARATORS.get(given["separator"], given["separator"])
    rows = chosen_rows("the map", given.pop("rows", {}))
    return Layout(**given | _lost(given.pop("lost", {})), rows=rows)


def _lost(entry: Any) -> dict[str, Any]:
    """What a lost reading is, and how many rows with one are left out."""
    if entry == LEAVE_OUT:
        return {"lost_rows": FEW}
    require_names("lost", entry, ("values", LEAVE_OUT))
    values, rows = entry.get("values", []), entry.get(LEAVE_OUT, 0)
    if not isinstance(values, list) or not all(isinstance(each, str | int | float) for each in values):
        raise ValueError(f"values of lost is {shown(values)}, must be a list such as [-9999, ERR]")
    if not isinstance(rows, int | float) or isinstance(rows, bool) or not 0 <= rows <= MOST_LOST:
        raise ValueError(
            f"{LEAVE_OUT} of lost is {shown(rows)}, must be a number of rows up to {MOST_LOST}, or a share such as 0.01"
        )
    return {"lost_values": tuple(map(str, values)), "lost_rows": rows}
