"""Which columns are the time, in which unit: by their names, and as time increases in even steps."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from swgsim.drafting.file_column import FileColumn
from swgsim.drafting.named_column import NamedColumn
from swgsim.drafting.stamps import form_of
from swgsim.tables.clock import STAMP, read_clock
from swgsim.tables.clock_jump import bits_of
from swgsim.tables.units import FACTORS

# Stamps that are looked at; all must have one form.
STAMPS_READ = 200
# Share of the steps that must be forward: a clock may stand where two samples have one stamp.
FORWARD = 0.99
# Scatter of the steps, as a share of a step, of a column without a name for time. Computers jitter by a tenth.
EVEN = 0.2
# Seconds since 1970 from 2000 to 2100.
EPOCH = (9.4e8, 4.1e9)
# Slowest log [Hz]: where no unit is said, the time has the largest unit for which the log is not slower.
SLOWEST_RATE = 5.0
# Robots and amplifiers log faster [Hz]: at a slower rate another unit is as likely, and is asked for.
USUAL_RATE = 50.0


@dataclass(frozen=True, eq=False)
class ClockDraft:
    """The time of a file.

    Attributes
    ----------
    columns : tuple of FileColumn
    entry : dict
        What a map says of it.
    time : array (time,)
        [s].
    why, question : str
    """

    columns: tuple[FileColumn, ...]
    entry: dict[str, Any]
    time: Float[np.ndarray, " time"]
    why: str
    question: str = ""


def drafted_clock(named: Sequence[NamedColumn]) -> ClockDraft | None:
    """The time among some columns; None if none of them is one."""
    columns = [each.column for each in named]
    of_time = [each.column for each in named if each.meaning.quantity == "time"]
    numbers = [each for each in of_time if not each.is_text and _forward(each)]
    others = [each for each in columns if each not in of_time and not each.is_text and evenness(each) < EVEN]
    pair = _pair(named)
    if pair:
        return _draft(pair, ["s", "ns"], "names: seconds and nanoseconds")
    if numbers:
        return _of_numbers(_likeliest(numbers), "name, increases")
    if stamps := _stamps(columns):
        forms = [form for _, form in stamps]
        kind = "time stamps by ISO 8601" if forms == [STAMP] else f"time stamps {' '.join(forms)}"
        return _draft([column for column, _ in stamps], forms, kind)
    if others:
        return _of_numbers(_likeliest(others), "increases in even steps")
    return None


def _likeliest(columns: Sequence[FileColumn]) -> FileColumn:
    """The one with the fewest lost readings, and among these with the most even steps."""
    return min(columns, key=lambda each: (each.lost, evenness(each)))


def _draft(columns: Sequence[FileColumn], units: Sequence[str], why: str, question: str = "") -> ClockDraft:
    bits = _bits(columns[0]) if len(columns) == 1 and not columns[0].is_text else 0
    why += f"; begins anew after {bits} bit" if bits else ""
    file = {"file": columns[0].file} if columns[0].file else {}
    if len(columns) == 1:
        counter = {"bits": bits} if bits else {}
        entry: dict[str, Any] = {"column": columns[0].column, "unit": units[0], **counter, **file}
    else:
        entry = {"columns": [each.column for each in columns], "units": list(units), **file}
    time = read_clock(entry).seconds({each.column: each.values for each in columns}, "the file")
    return ClockDraft(tuple(columns), entry, time, why, question)


def _pair(named: Sequence[NamedColumn]) -> list[FileColumn]:
    """Seconds and nanoseconds in two columns, as ROS writes them."""
    found = []
    for words in ({"sec", "secs"}, {"nsec", "nsecs", "nanosec", "nanosecs"}):
        same = (each.column for each in named if not each.column.is_text and words & set(each.meaning.words[-1:]))
        found.append(next(same, None))
    return [each for each in found if each] if all(found) else []


def _of_numbers(column: FileColumn, why: str) -> ClockDraft:
    if column.unit in FACTORS["s"]:
        return _draft([column], [column.unit], why)
    step, start = float(np.nanmedian(np.diff(column.values.astype(float)))), float(np.nanmin(column.values))
    for unit, factor in FACTORS["s"].items():
        if EPOCH[0] <= start * factor <= EPOCH[1]:
            return _draft([column], [unit], f"{why}; {unit} since 1970")
    fits = [unit for unit in ("s", "ms", "us", "ns") if 1 / (step * FACTORS["s"][unit]) >= SLOWEST_RATE]
    unit = fits[0] if fits else "s"
    rate = 1 / (step * FACTORS["s"][unit])
    return _draft(
        [column],
        [unit],
        f"{why}; {rate:.4g} samples per second",
        "" if unit == "s" and rate >= USUAL_RATE else "its unit",
    )


def _stamps(columns: Sequence[FileColumn]) -> list[tuple[FileColumn, str]]:
    """A column with day and time of day, or one of each."""
    forms = [(each, form_of([str(cell) for cell in each.values[:STAMPS_READ]])) for each in columns if each.is_text]
    known = [(each, form) for each, form in forms if form]
    whole = [(each, form) for each, form in known if form == STAMP and "T" in str(each.values[0]).upper()]
    whole += [(each, form) for each, form in known if (":" in str(each.values[0]) and " " in str(each.values[0]))]
    days = [(each, form) for each, form in known if ":" not in str(each.values[0])]
    clocks = [(each, form) for each, form in known if form != STAMP and "%d" not in form]
    if whole:
        return whole[:1]
    return [*days[:1], *clocks[:1]] if clocks else []


def _bits(column: FileColumn) -> int:
    """Bits of a counter that is full within the file; 0 for a clock that goes on."""
    back = {bits_of(-step) for step in np.diff(column.values.astype(float)) if step < 0}
    return back.pop() if len(back) == 1 else 0


def _forward(column: FileColumn) -> bool:
    """Whether a column increases."""
    steps = np.diff(column.values[np.isfinite(column.values.astype(float))])
    return len(steps) > 1 and bool(np.mean(steps > 0) >= FORWARD)


def evenness(column: FileColumn) -> float:
    """Scatter of the steps of an increasing column, as a share of a step; infinite for others."""
    if not _forward(column):
        return np.inf
    steps = np.diff(column.values[np.isfinite(column.values.astype(float))].astype(float))
    return float(np.std(steps) / np.median(steps)) if np.median(steps) > 0 else np.inf
