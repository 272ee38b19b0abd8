"""The columns of one run, from its file or its files, with the time of each sample."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from swgsim.tables import binary
from swgsim.tables.any_table import read_table
from swgsim.tables.clock import Clock
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.formats.spreadsheet import is_spreadsheet
from swgsim.tables.layout import FEW, LEAVE_OUT, Layout
from swgsim.tables.limits import require_readable
from swgsim.tables.measured_column import MeasuredColumn
from swgsim.tables.own_times import chosen, chosen_table, interpolated, own_time, require_same_clock
from swgsim.tables.text import Columns, start_of
from swgsim.tables.text_defects import row_of


@dataclass(frozen=True, eq=False)
class MeasuredTable:
    """Columns of one run.

    Attributes
    ----------
    numbers : tuple of array (time,)
        Of each wanted column, as in the file; rows with lost readings that may be left out are left out.
    time : array (time,), optional
        [s].
    lost : int
        Rows that were left out.
    first_row : int
        Row of the file with the first sample.
    """

    numbers: tuple[Float[np.ndarray, " time"], ...]
    time: Float[np.ndarray, " time"] | None
    lost: int
    first_row: int

    def __len__(self) -> int:
        return len(self.numbers[0])


def read_measured(
    folder: Path,
    files: Mapping[str, str],
    columns: Sequence[MeasuredColumn],
    clock: Clock | None,
    rate_hz: float | None,
    layout: Layout,
    reader: LimitedReader | None = None,
) -> MeasuredTable:
    """Read the columns of one run.

    Parameters
    ----------
    folder : Path
    files : mapping
        Value of the group ``signal`` to path in the folder; one file has the key ``""``.
    columns : sequence of MeasuredColumn
    clock : Clock, optional
    rate_hz : float, optional
        Sampling rate [Hz] in place of a clock; without both the run has no time.
    layout : Layout
    reader : LimitedReader, optional
        Reader that the files of a folder share.

    Raises
    ------
    FileDefect
        If a file is missing or cannot be read, the lengths differ, or more readings are lost than may be left out.
    """
    tables = {each: _read(folder, files, each, columns, clock, layout, reader) for each in _signals(columns, clock)}
    read = {signal: table for signal, (table, _) in tables.items()}
    first_row = next(iter(tables.values()))[1]
    name = next(iter(files.values()))
    numbers = [chosen(read[each.file], each.rows, each.own(read[each.file][each.place])) for each in columns]
    numbers = [each.astype(float) for each in numbers]
    time: Float[np.ndarray, " time"] | None = None
    if clock:
        times = chosen_table(read[clock.file], clock.rows, files[clock.file])
        origin = clock.origin(times, files[clock.file])
        time = clock.seconds(times, files[clock.file], origin)
        require_same_clock(read, files, clock, columns)
    own = [each.time is not None for each in columns]
    lengths = {
        f"{each.file} {each.column}".strip(): len(values)
        for each, values, alone in zip(columns, numbers, own, strict=True)
        if not alone
    } | ({"time": len(time)} if time is not None else {})
    if len(set(lengths.values())) > 1:
        expected = "as many values in each column; a signal with other times needs its own, such as time: t"
        raise FileDefect(name, f"columns of different lengths {lengths}", expected)
    if rate_hz is not None and lengths:
        time = np.arange(next(iter(lengths.values()))) / rate_hz
    together = [values for values, alone in zip(numbers, own, strict=True) if not alone]
    lost = _lost([*together, *([time] if time is not None else [])])
    left_out = 0
    if layout.lost_rows and len(lost):
        left_out = len(lost)
        rows = len(time if time is not None else together[0])
        _require_few(left_out, rows, "with lost readings", remedy(lost, rows), layout, name, first_row + int(lost[0]))
        if time is None:
            expected = f"a time or a rate, without which no row can be left out by {LEAVE_OUT} of lost"
            raise FileDefect(name, "no time", expected, first_row + int(lost[0]))
        kept = np.delete(np.arange(len(time)), lost)
        numbers = [values if alone else values[kept] for values, alone in zip(numbers, own, strict=True)]
        time = time[kept]
    if any(own):
        if not clock or time is None:
            raise FileDefect(name, "signals with times of their own", "a time of all, to which they are interpolated")
        others = {each: own_time(each, clock, read, files, origin) for each in columns if each.time is not None}
        rows = len(time)
        numbers, time, outside = interpolated(columns, numbers, time, others, name)
        left_out += outside
        if outside > FEW * rows:
            names = ", ".join(dict.fromkeys(str(each.column) for each in others))
            more = f"{LEAVE_OUT} of lost can be another number of rows"
            _require_few(left_out, rows, f"before or after the times of {names}", more, layout, name, first_row)
    return MeasuredTable(tuple(numbers), time, left_out, first_row)


def _require_few(lost: int, rows: int, why: str, more: str, layout: Layout, name: str, row: int) -> None:
    """Raise a FileDefect if more rows would be left out than may be."""
    most = int(layout.lost_rows * (rows if layout.lost_rows < 1 else 1))
    if lost > most:
        raise FileDefect(name, f"{lost} of {rows} rows {why}", f"at most {most}, as lost in the map says; {more}", row)


def first_lost(
    folder: Path, files: Mapping[str, str], columns: Sequence[MeasuredColumn], table: MeasuredTable, layout: Layout
) -> FileDefect | None:
    """The first number that is not finite, with its row, its column and what the map can say about it."""
    for column, values in zip(columns, table.numbers, strict=True):
        bad = _lost([values])
        if len(bad):
            name, index = files[column.file], int(bad[0])
            text = not (layout.raw or binary.is_binary(folder / name) or is_spreadsheet(folder / name))
            row = row_of(folder / name, layout, table.first_row, index) if text else index + table.first_row
            more = f" and {len(bad) - 1} more" if len(bad) > 1 else ""
            expected = f"a finite number; {remedy(bad, len(values))}"
            found = "no number" if np.isnan(values[index]) else str(values[index])
            return FileDefect(name, f"{found}{more}", expected, row, str(column.column))
    return None


def remedy(lost: Int[np.ndarray, " lost"], rows: int) -> str:
    """What the map can say about lost readings; a column that ends early or has few has another time than the rest."""
    at_end = lost[-1] + 1 == rows and lost[-1] - lost[0] + 1 == len(lost) > FEW * rows
    if at_end or 2 * len(lost) >= rows:
        return (
            "a signal that was sampled more slowly, or that ends earlier, needs its own time in a map, such as time: t"
        )
    return f"if readings were lost, set lost: {{{LEAVE_OUT}: {len(lost)}}} in a map, which leaves their rows out"


def _signals(columns: Iterable[MeasuredColumn], clock: Clock | None) -> list[str]:
    """Files of a run that have a wanted column."""
    return list(dict.fromkeys([*(column.file for column in columns), *([clock.file] if clock else [])]))


def _read(
    folder: Path, files: Mapping[str, str], signal: str, columns: Sequence[MeasuredColumn], clock: Clock | None,
    layout: Layout, reader: LimitedReader | None,
) -> tuple[Columns, int]:  # fmt: skip
    """The wanted columns of one file of a run, and the row of its first sample."""
    if signal not in files:
        found = f"the files {', '.join(files.values())}"
        raise FileDefect(str(folder), found, f"one with the signal {shown(signal)}, by 'path' and 'file' of the map")
    path, name = folder / files[signal], files[signal]
    require_readable(path)
    own = [each for each in columns if each.file == signal]
    times = [each.time for each in own if each.time is not None]
    rows = [column for column, _ in layout.rows] + [column for each in own for column, _ in each.rows]
    if clock and clock.file == signal:
        times += clock.columns
        rows += [column for column, _ in clock.rows]
    wanted = list(dict.fromkeys([*(each.place for each in own), *times, *rows]))
    if clock and clock.file != signal:
        also = _also(path, name, clock, wanted, layout)
        wanted, times = [*wanted, *also], [*times, *also]
    stamps = [*rows, *(times if clock and clock.stamps else ())]
    table, first_row = read_table(path, name, wanted, stamps, layout, reader)
    return chosen_table(table, layout.rows, name), first_row


def _also(path: Path, name: str, clock: Clock, wanted: Sequence[str | int], layout: Layout) -> list[str | int]:
    """Columns of another text file of a run that have the names of the time: they must say the same."""
    if binary.is_binary(path) or is_spreadsheet(path) or not layout.named:
        return []
    names = start_of(path, name, layout).names
    return [column for column in clock.columns if names.count(str(column)) == 1 and column not in wanted]


def _lost(columns: Sequence[Float[np.ndarray, " time"]]) -> Int[np.ndarray, " lost"]:
    """Rows in which a number is not finite."""
    return np.flatnonzero(~np.isfinite(columns).all(axis=0))
