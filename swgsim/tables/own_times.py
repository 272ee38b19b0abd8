"""Signals of one run that have rows or times of their own."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Shaped

from swgsim.tables.clock import Clock
from swgsim.tables.column_names import LISTED
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.measured_column import MeasuredColumn
from swgsim.tables.text import Columns


def chosen(
    read: Columns, rows: Sequence[tuple[str | int, str]], values: Shaped[np.ndarray, " _"]
) -> Shaped[np.ndarray, " _"]:
    """The values in the rows in which columns say something: texts, or whole numbers of a binary file."""
    return values[np.all([read[column].astype(str) == said for column, said in rows], axis=0)] if rows else values


def chosen_table(read: Columns, rows: Sequence[tuple[str | int, str]], name: str) -> Columns:
    """All columns in the chosen rows of a file; a FileDefect if there are none."""
    found = {column: chosen(read, rows, values) for column, values in read.items()}
    if rows and not len(next(iter(found.values()))):
        asked = " and ".join(f"{column} = {shown(said)}" for column, said in rows)
        said = ", ".join(map(shown, list(dict.fromkeys(read[rows[0][0]].astype(str).tolist()))[:LISTED]))
        raise FileDefect(name, f"no row with {asked}", f"one of {said}", column=str(rows[0][0]))
    return found


def require_same_clock(
    read: Mapping[str, Columns], files: Mapping[str, str], clock: Clock, columns: Sequence[MeasuredColumn]
) -> None:
    """Raise a FileDefect if a file of a run has other times in columns of the same names."""
    for signal, table in read.items():
        alone = all(each.time is not None for each in columns if each.file == signal)
        for column in clock.columns if signal != clock.file and not alone else ():
            named = isinstance(column, str) and column in table
            if named and not np.array_equal(table[column], read[clock.file][column]):
                expected = f"the times of {files[clock.file]}; give its signals their own time, such as time: {column}"
                raise FileDefect(files[signal], "other times", expected, column=str(column))


def own_time(
    column: MeasuredColumn, clock: Clock, read: Mapping[str, Columns], files: Mapping[str, str], origin: tuple
) -> Float[np.ndarray, " own"]:
    """Time of each value of a signal that has its own [s]."""
    assert column.time is not None
    if len(clock.columns) > 1:
        raise FileDefect(files[column.file], "a time of several columns", "one column, where a signal has its own time")
    table = chosen_table(read[column.file], column.rows, files[column.file])
    return replace(clock, columns=(column.time,)).seconds(table, files[column.file], origin)


class Together(NamedTuple):
    """Signals at the times that they share, and how many rows of the others lie outside of these."""

    numbers: list[Float[np.ndarray, " kept"]]
    time: Float[np.ndarray, " kept"]
    outside: int


def interpolated(
    columns: Sequence[MeasuredColumn],
    numbers: Sequence[Float[np.ndarray, " _"]],
    time: Float[np.ndarray, " time"],
    others: Mapping[MeasuredColumn, Float[np.ndarray, " _"]],
    name: str,
) -> Together:
    """All signals at the times that they share; those with times of their own are interpolated linearly.

    A wrapped angle is continuous before it is interpolated: between 359 and 1 degree it does not pass 180. A row within
    one step of the first or the last time of all is not counted as outside.
    """
    known = {}
    for each, values in zip(columns, numbers, strict=True):
        if each in others:
            there = np.isfinite(values) & np.isfinite(others[each])
            known[each] = others[each][there], each.unwrapped(values[there])
            if there.sum() < 2 or not (np.diff(known[each][0]) > 0).all():
                raise FileDefect(name, "a time that does not increase", "later times", column=str(each.time))
    first, last = max(times[0] for times, _ in known.values()), min(times[-1] for times, _ in known.values())
    kept = (time >= first) & (time <= last)
    if not kept.any():
        spans = "; ".join(f"{each.time}: {times[0]:.6g} to {times[-1]:.6g} s" for each, (times, _) in known.items())
        times_found = f"times of the others from {time[0]:.6g} to {time[-1]:.6g} s, and {spans}"
        raise FileDefect(name, times_found, "clocks that count from the same moment: correct one of them by its offset")
    step = max(np.median(np.diff(times)) for times, _ in known.values())
    outside = int(np.sum((time < first - step) | (time > last + step)))
    found = [
        each.wrapped(np.interp(time[kept], *known[each])) if each in known else values[kept]
        for each, values in zip(columns, numbers, strict=True)
    ]
    return Together(found, time[kept], outside)
