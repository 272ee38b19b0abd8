"""Channels that each have a time column of their own before them, as scopes write them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from swgsim.drafting.clock import EVEN, ClockDraft, evenness
from swgsim.drafting.file_column import FileColumn

# Share of the time of all by which another time may begin and end elsewhere.
APART = 0.01


def own_times(columns: Sequence[FileColumn], clock: ClockDraft) -> tuple[list[FileColumn], list[FileColumn]]:
    """Signals with their own times, and the columns of these times.

    Parameters
    ----------
    columns : sequence of FileColumn
        All columns of a file, in its order.
    clock : ClockDraft
        The time of all. Signals with other times get its values by interpolation, as when they are read.
    """
    rest = [each for each in columns if each not in clock.columns]
    main = clock.columns[0]
    if len(clock.columns) > 1 or main.is_text or columns[0] is not main:
        return rest, []
    others = [each for each in rest if _is_time(each, main)]
    places = [columns.index(each) for each in (main, *others)]
    if not others or len(columns) - 1 in places or 1 in np.diff(places):
        return rest, []
    found, time = [], main
    for each in rest:
        if each in others:
            time = each
        else:
            found.append(each if np.array_equal(time.values, main.values) else _at(each, time, main))
    return found, others


def _is_time(column: FileColumn, main: FileColumn) -> bool:
    """Whether a column increases in even steps over the same time as another one."""
    if column.is_text or evenness(column) > EVEN:
        return False
    ends, wanted = (each.values[np.isfinite(each.values)][[0, -1]] for each in (column, main))
    return bool(np.all(np.abs(ends - wanted) <= APART * np.ptp(wanted)))


def _at(signal: FileColumn, time: FileColumn, main: FileColumn) -> FileColumn:
    """A signal at the times of another one."""
    if signal.is_text:
        return signal
    there = np.isfinite(time.values) & np.isfinite(signal.values)
    values = np.interp(main.values, time.values[there], signal.values[there])
    return replace(signal, values=values, lost=0, time=time.column)
