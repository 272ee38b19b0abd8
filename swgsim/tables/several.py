"""Several recordings in one file: groups, elements of a struct array, or sheets."""

import re
from collections.abc import Iterator
from pathlib import Path

from swgsim.tables import binary
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.formats.spreadsheet import is_spreadsheet, sheets
from swgsim.tables.path_pattern import path_groups

# Names that a message lists.
LISTED = 10


def recordings_in(path: Path, name: str, pattern: str, reader: LimitedReader) -> list[tuple[str, dict[str, str]]]:
    """Names of the recordings of a file, each with the groups of the pattern.

    Parameters
    ----------
    path : Path
    name : str
        Name of the file in messages.
    pattern : str
        Regular expression for the whole name of a group, of an element of a struct array such as ``trials[1]``, or of a
        sheet.
    reader : LimitedReader

    Raises
    ------
    FileDefect
        If the file has no such parts, or none that matches.
    """
    if is_spreadsheet(path):
        parts = sheets(path, name, reader)
    elif binary.is_binary(path):
        parts = list(dict.fromkeys(part for each in binary.names(path, name, reader) for part in _containers(each)))
    else:
        raise FileDefect(name, "a text file", "a file with groups, struct arrays or sheets, where a map has 'each'")
    found = [(part, groups) for part in parts if (groups := path_groups(pattern, part)) is not None]
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
