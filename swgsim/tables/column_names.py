"""Which column of a table a name, a pattern or a number means."""

from collections.abc import Sequence
from difflib import get_close_matches
from fnmatch import fnmatchcase

from swgsim.tables.file_defect import FileDefect, shown

# Names that a message lists.
LISTED = 20


def column_place(wanted: str | int, present: Sequence[str], file: str, row: int | None = None) -> int:
    """Position of one column, from 0.

    Parameters
    ----------
    wanted : str or int
        Its name; a pattern with ``*`` and ``?``, where the names differ by file; or its number from 1. A name that the
        table has as it stands is no pattern.
    present : sequence of str
        Names of all columns.
    file : str
        Name of the file in messages.
    row : int, optional
        Row of the file with the names.

    Raises
    ------
    FileDefect
        If no column or several columns are meant.

    Examples
    --------
    >>> column_place("X*_time", ["X097_s0", "X097_time"], "run1.mat")
    1
    >>> column_place("Angle * [deg]", ["Angle 1 d", "Angle 1 [deg]"], "run1.mat")
    1
    """
    if isinstance(wanted, int):
        if not 1 <= wanted <= len(present):
            raise FileDefect(file, f"{len(present)} columns", f"a column {wanted}, as the map says", row)
        return wanted - 1
    places = [place for place, name in enumerate(present) if name == wanted]
    pattern = wanted.replace("[", "[[]")  # brackets are parts of names, such as "Angle [deg]"
    places = places or [place for place, name in enumerate(present) if fnmatchcase(name, pattern)]
    if len(places) == 1:
        return places[0]
    if places:
        found = f"{len(places)} columns {', '.join(shown(present[place]) for place in places[:LISTED])}"
        raise FileDefect(file, found, f"one column {shown(wanted)}; give its number from 1 instead of its name", row)
    near = get_close_matches(wanted, present, n=1)
    hint = f" (is {shown(near[0])} meant?)" if near else ""
    listed = ", ".join(map(shown, present[:LISTED])) + (", …" if len(present) > LISTED else "")
    raise FileDefect(file, f"the columns {listed or 'none'}", f"{shown(wanted)}, as the map says{hint}", row)
