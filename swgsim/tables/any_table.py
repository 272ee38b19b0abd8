"""Columns of a file of any kind: text, a spreadsheet, or a binary format."""

from collections.abc import Sequence
from pathlib import Path

from swgsim.tables import binary
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.formats.spreadsheet import is_spreadsheet
from swgsim.tables.layout import Layout
from swgsim.tables.raw_numbers import read_raw
from swgsim.tables.repeated_names import layout_of_table
from swgsim.tables.spreadsheet_table import read_spreadsheet
from swgsim.tables.text import Columns, read_text, start_of


def read_table(
    path: Path,
    name: str,
    wanted: Sequence[str | int],
    texts: Sequence[str | int],
    layout: Layout,
    reader: LimitedReader | None = None,
) -> tuple[Columns, int]:
    """The wanted columns of one file, and the row of its first sample.

    Parameters
    ----------
    path : Path
    name : str
        Name of the file in messages.
    wanted : sequence of str or int
    texts : sequence of str or int
        Those that are read as text, where the file has text.
    layout : Layout
    reader : LimitedReader, optional

    Raises
    ------
    FileDefect
        If the file cannot be read, or a column is missing.
    """
    if layout.raw:
        return read_raw(path, name, wanted, layout), 1
    if binary.is_binary(path):
        return binary.read_columns(path, name, wanted, reader), 1
    if is_spreadsheet(path):
        return read_spreadsheet(path, name, wanted, layout, texts, reader)
    if layout.sheet:
        layout = layout_of_table(path, name, layout)
    before = layout.lines.start if layout.lines else 0
    try:
        return read_text(path, name, wanted, layout, texts), before + start_of(path, name, layout).row
    except FileDefect as defect:
        row = None if defect.row is None else before + defect.row
        raise FileDefect(defect.file, defect.found, defect.expected, row, defect.column) from None
