"""Spreadsheets: tables of cells with header rows, as text files are."""

from contextlib import nullcontext
from pathlib import Path

from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.limits import require_readable

ENDINGS = (".xlsx", ".xlsm")
OTHERS = (".xls", ".xlsb", ".ods")


def is_spreadsheet(path: Path) -> bool:
    """Whether a file is a spreadsheet, by its ending.

    >>> is_spreadsheet(Path("Run1.XLSX"))
    True
    """
    return path.suffix.lower() in (*ENDINGS, *OTHERS)


def cells(
    path: Path, name: str, sheet: str | int | None = None, reader: LimitedReader | None = None
) -> list[list[float | int | str | bool | None]]:
    """Rows of a sheet, each up to its last cell that is not empty.

    Parameters
    ----------
    path : Path
    name : str
        Name of the file in messages.
    sheet : str or int, optional
        Name of the sheet, or its number from 1; by default the only one.
    reader : LimitedReader, optional
        Child process that the files of a folder share.

    Returns
    -------
    list of list
        Numbers, texts, truth values, and None for an empty cell. A date is a text as ISO 8601 has it, a time of day a
        number of seconds. The value of a formula is the one that was saved with it.

    Raises
    ------
    FileDefect
        If the file is damaged or of an older format, or has no such sheet or too many cells.
    """
    _require_known(path, name)
    with nullcontext(reader) if reader else LimitedReader() as child:
        return child.cells(path, name, "workbook", sheet)


def sheets(path: Path, name: str, reader: LimitedReader | None = None) -> list[str]:
    """Names of the sheets; parameters and errors as for :func:`cells`."""
    _require_known(path, name)
    with nullcontext(reader) if reader else LimitedReader() as child:
        return child.sheets(path, name, "workbook")


def _require_known(path: Path, name: str) -> None:
    """Raise a FileDefect unless a spreadsheet is of a format that is read."""
    require_readable(path)
    if path.suffix.lower() in OTHERS:
        raise FileDefect(name, path.suffix, f"{' or '.join(ENDINGS)}: save the spreadsheet in this format, or as CSV")
