"""Which entry of a binary file a reference means: a name, a pattern, a path, a row or column of a matrix, a number."""

import re
from collections.abc import Sequence
from fnmatch import fnmatchcase
from typing import NamedTuple

import numpy as np

from swgsim.tables.cell_lists import ELEMENT
from swgsim.tables.column_names import LISTED, column_place
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.formats.contents import CONTAINERS, NUMBERS, OBJECTS, Contents, Listed

TABLE_REMEDY = "for a table t, in MATLAB: s = table2struct(t, 'ToScalar', true); save('run1.mat', '-struct', 's')"


class Reference(NamedTuple):
    """Place of an entry in the list of a file, and the row or column of a matrix, from 0."""

    place: int
    line: int | None = None


def referred(wanted: str | int, contents: Contents, file: str) -> Reference:
    """The entry that a reference means.

    A name that the file has as it stands comes first; then ``struct.field``, ``group/channel``, ``runs[3].q`` for the
    third element, ``tau[4]`` for the fourth row or column of a matrix, and last a pattern with ``*`` and ``?``.

    Parameters
    ----------
    wanted : str or int
        A number counts from 1: the columns of a table, or of the only matrix of a file.
    contents : Contents
    file : str
        Its name in messages.

    Raises
    ------
    FileDefect
        If nothing, several entries or no numbers are meant.
    """
    if isinstance(wanted, int):
        return _numbered(wanted, contents, file)
    place, line = _place(wanted, contents, file), None
    if place is None and (match := ELEMENT.fullmatch(wanted)):
        place, line = _place(match[1], contents, file), int(match[2]) - 1
    if place is None:
        raise _missing(wanted, contents, file)
    entry = contents.listed[place]
    _require_numbers(entry, contents, file)
    if line is not None or _is_matrix(entry):
        _require_line(entry, line, file)
    return Reference(place, line)


def column(values: np.ndarray, line: int | None) -> np.ndarray:
    """A vector as it is, or one row or column of a matrix, whose longer side is the time.

    >>> column(np.arange(6).reshape(3, 2), 1)
    array([1, 3, 5])
    """
    if line is None:
        return values.ravel()
    rows, columns = (length for length in values.shape if length != 1)
    matrix = values.reshape(rows, columns)
    return np.ascontiguousarray(matrix[:, line] if rows > columns else matrix[line])


def _numbered(wanted: int, contents: Contents, file: str) -> Reference:
    """The column of a number from 1."""
    names = [entry.name for entry in contents.listed]
    if not contents.ordered:
        matrices = [place for place, entry in enumerate(contents.listed) if _is_matrix(entry)]
        if len(matrices) != 1:
            found = f"the number {wanted} and {len(matrices)} matrices"
            raise FileDefect(file, found, "a name: the variables have no order")
        entry = contents.listed[matrices[0]]
        _require_line(entry, wanted - 1, file)
        return Reference(matrices[0], wanted - 1)
    place = column_place(wanted, names, file)
    _require_numbers(contents.listed[place], contents, file)
    return Reference(place)


def _place(wanted: str, contents: Contents, file: str) -> int | None:
    """Place of a name, of one with other separators, or of a pattern; None if there is none."""
    names = [entry.name for entry in contents.listed]
    if names.count(wanted) > 1 and not contents.ordered:
        raise FileDefect(file, f"{names.count(wanted)} variables of this name", "one", column=wanted)
    if wanted in names:
        return column_place(wanted, names, file)
    if wanted in contents.others:
        return contents.others[wanted]
    plain = wanted.strip("/").replace("/", ".")
    alike = [place for place, name in enumerate(names) if name.replace("/", ".") == plain]
    if len(alike) == 1:
        return alike[0]
    pattern = wanted.replace("[", "[[]")  # brackets are parts of names
    leaves = [place for place, entry in enumerate(contents.listed) if entry.kind not in CONTAINERS]
    matching = [place for place in leaves if fnmatchcase(names[place], pattern)]
    if len(matching) > 1:
        found = _listing([contents.listed[place] for place in matching])
        raise FileDefect(file, found, f"one column {shown(wanted)}: write more of its name")
    return matching[0] if matching else None


def _missing(wanted: str, contents: Contents, file: str) -> FileDefect:
    """The refusal of a name that the file has not."""
    names = [entry.name for entry in contents.listed if entry.kind not in CONTAINERS or not _members(entry, contents)]
    objects = [entry for entry in contents.listed if entry.kind in OBJECTS]
    if objects:
        found = f"{_listing(contents.listed)}, of which objects are read by MATLAB alone"
        return FileDefect(file, found, f"{shown(wanted)}, as the map says; {TABLE_REMEDY}")
    try:
        column_place(wanted, names, file)
    except FileDefect as defect:
        return defect
    return FileDefect(file, f"nothing in {shown(wanted)}", "real numbers")


def _require_numbers(entry: Listed, contents: Contents, file: str) -> None:
    """Raise a FileDefect unless an entry is numbers."""
    if entry.kind in CONTAINERS:
        members = _members(entry, contents)
        if not members:
            raise FileDefect(file, f"a {entry.kind} without numbers", "real numbers", column=entry.name)
        found = f"a {entry.kind} with {_listing(members)}"
        example = next((each.name for each in members if each.kind in NUMBERS), members[0].name)
        raise FileDefect(file, found, f"real numbers: name one of these, such as {example}", column=entry.name)
    if entry.kind not in NUMBERS:
        found = f"{shown(entry.kind)} of shape {shown(entry.shape)}"
        remedy = f"; {TABLE_REMEDY}" if entry.kind in OBJECTS else ""
        raise FileDefect(file, found, f"real numbers{remedy}", column=entry.name)
    if len([length for length in entry.shape if length != 1]) > 2:
        raise FileDefect(file, f"numbers of shape {entry.shape}", "real numbers in rows and columns", column=entry.name)


def _require_line(entry: Listed, line: int | None, file: str) -> None:
    """Raise a FileDefect unless an entry is a matrix with a row or column of that place."""
    sides = tuple(length for length in entry.shape if length != 1)
    if len(sides) != 2:
        found, expected = f"numbers of shape {entry.shape}", f"a matrix; the name alone, {entry.name}, means a vector"
        raise FileDefect(file, found, expected, column=entry.name)
    if sides[0] == sides[1]:
        expected = "a matrix with a longer side, which is the time: save its columns under names of their own"
        raise FileDefect(file, f"a square matrix {sides[0]} x {sides[1]}", expected, column=entry.name)
    if line is None or not 0 <= line < min(sides):
        asked = "" if line is None else f", but no {line + 1}"
        found = f"a matrix {sides[0]} x {sides[1]} with {min(sides)} signals{asked}"
        expected = f"real numbers in one row or column: {entry.name}[1] to {entry.name}[{min(sides)}]"
        raise FileDefect(file, found, expected, column=entry.name)


def _is_matrix(entry: Listed) -> bool:
    """Whether an entry is numbers in several rows and columns."""
    return entry.kind in NUMBERS and len([length for length in entry.shape if length != 1]) == 2


def _members(entry: Listed, contents: Contents) -> list[Listed]:
    """The entries within a struct, group or cell array."""
    inside = re.compile(re.escape(entry.name) + r"[.\[/]")
    return [each for each in contents.listed if inside.match(each.name) and each.kind not in CONTAINERS]


def _listing(entries: Sequence[Listed]) -> str:
    """Names and shapes, for messages."""
    texts = [f"{shown(entry.name)} ({' x '.join(map(str, entry.shape)) or 'one number'})" for entry in entries[:LISTED]]
    return ", ".join(texts) + (", …" if len(entries) > LISTED else "")
