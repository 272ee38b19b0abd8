"""What a file shows: its columns with their names, their units and their first numbers."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from io import StringIO
from pathlib import Path

import numpy as np
import pandas as pd

from swgsim.drafting.binary_columns import MOST_SIGNALS, SHEET, binary_columns, sheet_lines
from swgsim.drafting.file_column import MOST_ROWS, FileColumn, within
from swgsim.drafting.first_recording import first_of_rows, first_table
from swgsim.drafting.interleaved import interleaved_in
from swgsim.drafting.text_layout import TextLayout, layout_of, text_layout
from swgsim.drafting.units import split_unit, unit_in
from swgsim.tables import binary
from swgsim.tables.cell_lists import lists_of
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.spreadsheet import is_spreadsheet
from swgsim.tables.layout import LOST_READINGS, Layout
from swgsim.tables.measured_column import EACH


@dataclass(frozen=True, eq=False)
class FileContents:
    """One file, or the files of one run that are joined.

    Attributes
    ----------
    columns : tuple of FileColumn
        Of numbers or time stamps, all of the same length.
    others : mapping of str to str
        Name of what else the file holds, and what it is.
    layout : Layout, optional
        Of text.
    interleaved : int
        How many signals follow one another in the only column.
    """

    columns: tuple[FileColumn, ...]
    others: Mapping[str, str] = field(default_factory=dict)
    layout: Layout | None = None
    interleaved: int = 1

    @property
    def names(self) -> tuple[tuple[str | int, str], ...]:
        """What files that are read by the same map have in common."""
        return tuple((each.column, each.unit) for each in self.columns)


def contents_of(path: Path, name: str) -> FileContents:
    """Look at a file, of several recordings at the first.

    Raises
    ------
    FileDefect
        If it holds no table of numbers.
    """
    contents = _contents_of(path, name)
    columns, by = first_of_rows(contents.columns)
    return (
        contents
        if by is None
        else replace(contents, columns=columns, layout=replace(contents.layout or Layout(), rows=((by, EACH),)))
    )


def _contents_of(path: Path, name: str) -> FileContents:
    """All rows of a file."""
    if binary.is_binary(path):
        columns, others = binary_columns(path, name)
        return FileContents(columns, others)
    if is_spreadsheet(path):
        lines = sheet_lines(path, name)
        found = layout_of(lines, [SHEET], Layout().encoding, name)
        return _text(found, StringIO("\n".join(lines)), replace(found.layout, separator=Layout().separator))
    found = text_layout(path, name)
    return _text(found, path, found.layout)


def _text(found: TextLayout, source: Path | StringIO, layout: Layout) -> FileContents:
    """The columns of a table of text."""
    table = _table(source, found)
    if end := first_table(table, found.names, found.layout):
        table, layout = table[:end], replace(layout, sheet=EACH)
    columns = tuple(_text_columns(table, found))
    numbers = tuple(each for each in columns if not each.is_empty)
    others = {str(each.column): "empty" for each in columns if each.is_empty}
    return FileContents(numbers, others, layout)


def joined(contents: Mapping[str, FileContents], name: str) -> FileContents:
    """The files of one run, by their signal, as one; files with one column may have several signals in turn.

    Raises
    ------
    FileDefect
        If their lengths differ otherwise.
    """
    first = next(iter(contents.values()))
    lengths = {signal: len(each.columns[0].values) for signal, each in contents.items()}
    single = all(len(each.columns) == 1 for each in contents.values())
    turns = max(lengths.values()) // min(lengths.values())
    if single and turns == 1:
        turns = min(interleaved_in(each.columns[0].values) for each in contents.values())
    rows = max(lengths.values()) // turns
    if any(length not in (rows, rows * turns) for length in lengths.values()) or (turns > 1 and not single):
        raise FileDefect(name, f"files of one run with different lengths {lengths}", "as many rows in each")
    columns: list[FileColumn] = []
    for signal, one in contents.items():
        whole = [replace(each, file=signal) for each in one.columns]
        columns += _in_turn(whole[0], turns) if turns > 1 and lengths[signal] == rows * turns else whole
    return FileContents(tuple(columns), {}, first.layout, turns)


def _in_turn(column: FileColumn, turns: int) -> Iterator[FileColumn]:
    """The signals that follow one another in a column."""
    for number in range(turns):
        yield replace(
            column, column=number + 1, name=f"{column.file}[{number + 1}]", values=column.values[number::turns]
        )


def _table(source: Path | StringIO, found: TextLayout) -> pd.DataFrame:
    """The cells of a table of text."""
    layout = found.layout
    table = pd.read_csv(
        source,
        sep=r"\s+" if layout.separator == " " else layout.separator,
        decimal=layout.decimal,
        encoding=layout.encoding,
        skiprows=found.first_row - 1,
        names=range(found.width),
        index_col=False,
        comment=layout.comment or None,
        na_values=list(LOST_READINGS),
        keep_default_na=False,
        skipinitialspace=True,
        on_bad_lines="skip",
        nrows=MOST_ROWS,
        low_memory=False,
    )
    # Empty rows at the end are none.
    return table[: int(np.flatnonzero(table.notna().any(axis=1)).max(initial=-1)) + 1]


def _text_columns(table: pd.DataFrame, found: TextLayout) -> Iterator[FileColumn]:
    """The columns of a table, and those of the lists in its cells."""
    for place in range(found.width):
        name = found.names[place] if place < len(found.names) else ""
        bare, unit = split_unit(name)
        values = table[place]
        if values.dtype.kind not in "iuf":
            decimal = found.layout.decimal
            numbers = pd.to_numeric(values.astype(str).str.replace(decimal, ".", regex=False), errors="coerce")
            # A column is one of numbers if most of its cells are.
            values = numbers if 2 * numbers.notna().sum() > values.notna().sum() else values.astype(str)
        column = name if name and found.names.count(name) == 1 else place + 1
        unit = unit or unit_in(found.units[place])
        signals = _of_lists(values) if column == name else []
        for number, signal in enumerate(signals, 1):
            yield FileColumn(f"{name}[{number}]", f"{bare}[{number}]", unit, signal, "", int(np.isnan(signal).sum()))
        if not signals:
            readings = within(values.to_numpy())
            yield FileColumn(column, bare, unit, readings, "", int(pd.isna(readings).sum()))


def _of_lists(cells: pd.Series) -> list[np.ndarray]:
    """The numbers at each place of the lists in some cells; none if the cells are no lists of numbers."""
    lists = lists_of(cells) if cells.dtype.kind not in "iuf" else pd.Series(dtype=object)
    if lists.isna().mean() > 0.5 or not len(lists) or not 0 < (width := int(lists.str.len().min())) <= MOST_SIGNALS:
        return []
    numbers = [pd.to_numeric(lists.str[place], errors="coerce").to_numpy(dtype=float) for place in range(width)]
    return [] if all(np.isnan(values).all() for values in numbers) else numbers
