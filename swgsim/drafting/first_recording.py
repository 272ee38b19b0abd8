"""The first recording of a file that has several: tables below one another, or a column that numbers them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from swgsim.drafting.clock import drafted_clock
from swgsim.drafting.file_column import FileColumn
from swgsim.drafting.named_column import NamedColumn
from swgsim.drafting.words import meaning_of
from swgsim.tables.layout import Layout
from swgsim.tables.text_stream import number_of


def first_table(table: pd.DataFrame, names: Sequence[str], layout: Layout) -> int:
    """The number of rows before the row of names comes again; 0 if it does not."""
    if not any(names) or any(kind.kind in "iuf" for kind in table.dtypes):
        return 0
    again = np.logical_and.reduce([table[place].astype(str).str.strip() == name for place, name in enumerate(names)])
    end = int(np.argmax(again)) if again.any() else 0
    while end and not any(number_of(str(cell), layout) is not None for cell in table.iloc[end - 1]):
        end -= 1
    return end


def first_of_rows(columns: Sequence[FileColumn]) -> tuple[tuple[FileColumn, ...], str | int | None]:
    """The rows of the first recording, and the column that says another word wherever the clock runs back."""
    clock = drafted_clock([NamedColumn(each, meaning_of(each)) for each in columns])
    back = np.flatnonzero(np.diff(clock.time) < 0) + 1 if clock else np.empty(0, int)
    for column in columns if len(back) else ():
        said = column.values.astype(str)
        changes = np.flatnonzero(said[1:] != said[:-1]) + 1
        if np.array_equal(changes, back) and len(set(said[back])) == len(back) and said[0] not in said[back]:
            first = [each.values[: back[0]] for each in columns]
            lost = [int(pd.isna(values).sum()) for values in first]
            kept = zip(columns, first, lost, strict=True)
            return tuple(replace(each, values=values, lost=count) for each, values, count in kept), column.column
    return tuple(columns), None
