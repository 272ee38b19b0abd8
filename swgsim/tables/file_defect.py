"""Defect of a file, with file, row, column, found and expected value."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from reprlib import Repr

# Rows are numbered as lines of an editor: the header is row 1, the first sample row 2.
FIRST_ROW = 2

# A found value is shown up to this many characters.
SHOWN_CHARACTERS = 60
# Nested values could fill the memory as text, so they are abbreviated.
_SHORT = Repr()
_SHORT.maxlong = _SHORT.maxother = _SHORT.maxstring = 2 * SHOWN_CHARACTERS


class FileDefect(ValueError):
    """Error for a file that cannot be read as recordings.

    Parameters
    ----------
    file : str
    found, expected : str
    row : int, optional
        Row of the file; samples begin at :data:`FIRST_ROW`.
    column : str, optional
    """

    def __init__(self, file: str, found: str, expected: str, row: int | None = None, column: str | None = None) -> None:
        self.file, self.row, self.column, self.found, self.expected = file, row, column, found, expected
        place = [file, *([f"row {row}"] if row else []), *([f"column {column}"] if column else [])]
        super().__init__(f"{', '.join(place)}: found {found}, expected {expected}")


@contextmanager
def read_for(choice: str, path: str) -> Iterator[None]:
    """Add the choice and the folder to a FileDefect, as many folders hold files of the same name.

    Raises
    ------
    ValueError
        For a FileDefect.
    """
    try:
        yield
    except FileDefect as defect:
        place = "" if Path(defect.file) == Path(path) else f"{path}: "
        raise ValueError(f"{choice}={place}{defect}") from defect


def shown(value: object) -> str:
    """A found value in quotes, abbreviated if it is long.

    >>> shown("3,14")
    "'3,14'"
    """
    text = value if isinstance(value, str) else _SHORT.repr(value)
    return repr(text if len(text) <= SHOWN_CHARACTERS else text[:SHOWN_CHARACTERS] + "…")
