"""Time stamps of text: which form they have."""

import re
from collections.abc import Sequence
from itertools import product

import pandas as pd

from swgsim.tables.clock import STAMP

ISO = re.compile(r"\d{4}-\d{2}-\d{2}([T ]\d{2}:\d{2}(:\d{2}([.,]\d+)?)?)?(Z|[+-]\d{2}:?\d{2})?")
OTHER = re.compile(
    r"\d{1,4}[./-]\d{1,2}[./-]\d{1,4}([ T]\d{1,2}:\d{2}(:\d{2}([.,]\d+)?)?)?|\d{1,2}:\d{2}(:\d{2}([.,]\d+)?)?"
)
DAYS = ("%d.%m.%Y", "%d.%m.%y", "%Y/%m/%d", "%d/%m/%Y", "%m/%d/%Y", "%Y-%m-%d", "%Y.%m.%d")
TIMES = ("%H:%M:%S.%f", "%H:%M:%S,%f", "%H:%M:%S", "%H:%M")
FORMS = (*(f"{day} {time}" for day, time in product(DAYS, TIMES)), *DAYS, *TIMES)


def is_stamp(cell: str) -> bool:
    """Whether a cell is a date, a time of day or both.

    >>> is_stamp("2026-03-12T10:22:31.123"), is_stamp("12.03.2026 10:22:31"), is_stamp("3.14")
    (True, True, False)
    """
    return bool(ISO.fullmatch(cell) or OTHER.fullmatch(cell))


def form_of(cells: Sequence[str]) -> str | None:
    """The unit of a column of time stamps in a map: ``iso`` or a format; None if no form fits all cells.

    >>> form_of(["12.03.2026 10:22:31,5", "13.03.2026 10:22:31,7"])
    '%d.%m.%Y %H:%M:%S,%f'
    """
    if cells and all(ISO.fullmatch(cell) for cell in cells):
        return STAMP
    for form in FORMS if all(map(is_stamp, cells)) else ():
        if cells and pd.to_datetime(pd.Series(cells), format=form, errors="coerce").notna().all():
            return form
    return None
