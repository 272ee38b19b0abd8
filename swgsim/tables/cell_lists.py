"""Lists in the cells of a text table, as exports of ROS have them: ``[0.1, 0.2]``, ``array('d', [0.1, 0.2])``."""

import re
from collections.abc import Sequence

import numpy as np
import pandas as pd

from swgsim.tables.file_defect import FileDefect, shown

ELEMENT = re.compile(r"(.+)\[(\d{1,6})\]")


def list_and_number(column: str | int, names: Sequence[str]) -> tuple[str | int, int | None]:
    """The column of lists and the number of an element from 1; a column that is there as it stands has none.

    >>> list_and_number("position[3]", ["time", "position"])
    ('position', 3)
    >>> list_and_number("q[3]", ["time", "q[3]"])
    ('q[3]', None)
    """
    found = ELEMENT.fullmatch(str(column))
    if column in names or found is None or found[1] not in names:
        return column, None
    return found[1], int(found[2])


def elements(cells: pd.Series, number: int, name: str, column: str, first_row: int) -> pd.Series:
    """One element of each list, as text; cells that are no lists stay as they are.

    Raises
    ------
    FileDefect
        If a list is too short, or elements are counted from 0.
    """
    if number < 1:
        raise FileDefect(name, f"element {number}", "a number from 1", column=column)
    lists = lists_of(cells)
    short = np.flatnonzero((lists.str.len() < number).fillna(False))
    if len(short):
        found = f"{shown(str(cells.iloc[short[0]]))}, a list of {len(lists.iloc[short[0]])}"
        raise FileDefect(name, found, f"at least {number} numbers", first_row + int(short[0]), column)
    return lists.str[number - 1].where(lists.notna(), cells)


def lists_of(cells: pd.Series) -> pd.Series:
    """The elements of the list in each cell, as texts; a missing value for a cell that is none.

    >>> lists_of(pd.Series(["array('d', [2, 3])", "ok (1)"])).tolist()
    [['2', '3'], <NA>]
    """
    found = cells.astype("string").str.extract(r"^\s*(?:array\(.*)?[\[(]\s*([^\[\]()]*?)\s*[\])]")[0]
    return found.str.split(r"[,;\s]+", regex=True)
