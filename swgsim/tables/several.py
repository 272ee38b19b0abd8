"""Several recordings in one file: groups, elements of a struct array, sheets, tables, or rows of one table."""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from swgsim.tables import binary
from swgsim.tables.any_table import read_table
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.formats.spreadsheet import is_spreadsheet, sheets
from swgsim.tables.measured_column import EACH
from swgsim.tables.path_pattern import path_groups
from swgsim.tables.repeated_names import tables_of
from swgsim.tables.table_map import TableMap

# Names that a message lists.
LISTED = 10


def recordings_in(path: Path, name: str, table: TableMap, reader: LimitedReader) -> list[tuple[str, dict[str, Any]]]:
    """Names of the recordings of a file, each with the groups of the pattern.

    Parameters
    ----------
    path : Path
    name : str
        Name of the file in messages.
    table : TableMap
        Its ``each`` is a pattern for the whole name of a group, of an element of a struct array such as ``trials[1]``,
        of a sheet, for the number of a table of a text file, or for what a column says; ``of_each`` has facts by name.
    reader : LimitedReader

    Raises
    ------
    FileDefect
        If the file has no such parts, or none that matches.
    """
    layout, pattern = table.layout, table.each
    by_rows = [column for column, said in layout.rows if EACH in said]
    if by_rows:
        every = replace(layout, rows=())
        said, _ = read_table(path, name, by_rows, by_rows, every, reader)
        parts = list(dict.fromkeys(said[by_rows[0]].astype(str).tolist()))
    elif is_spreadsheet(path):
        parts = sheets(path, name, reader)
    elif binary.is_binary(path):
        parts = list(dict.fromkeys(part for each in binary.names(path, name, reader) for part in _containers(each)))
    elif EACH in layout.sheet:
        parts = [str(number) for number in range(1, 1 + len(tables_of(path, name, layout)))]
    else:
        expected = f"a file with groups, struct arrays or sheets, or {EACH} in 'rows' or 'sheet' of the map"
        raise FileDefect(name, "a text file", expected)
    found = [
        (part, {**groups, **table.of_each.get(part, {})})
        for part in parts
        if (groups := path_groups(pattern, part)) is not None
    ]
    absent = [part for part in table.of_each if part not in parts]
    if absent:
        raise FileDefect(name, f"no part {shown(absent[0])} of 'each'", f"one of {', '.join(parts[:LISTED])}")
    if not found:
        listed = ", ".join(map(shown, parts[:LISTED])) or "none"
        raise FileDefect(name, f"the parts {listed}", f"some that match 'each' of the map, {pattern}")
    return sorted(found, key=lambda each: [int(x) if x.isdigit() else x for x in re.split(r"(\d+)", each[0])])


def _containers(name: str) -> Iterator[str]:
    """The groups and elements that a name lies in.

    >>> list(_containers("data/demo_1/q")), list(_containers("trials[2].q"))
    (['data', 'data/demo_1'], ['trials', 'trials[2]'])
    """
    for found in re.finditer(r"(?<=.)[/.\[]", name):
        before = name[: found.start()]
        if not before.endswith("]"):
            yield before
        if found[0] == "[" and "]" in name[found.start() :]:
            yield name[: name.index("]", found.start()) + 1]
