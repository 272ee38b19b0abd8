"""From facts and columns to a recording, with the checks that all formats share."""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float, Int

from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.recordings.recording import CHANNELS, Recording
from swgsim.tables.file_defect import FIRST_ROW, FileDefect, shown
from swgsim.tables.limits import LARGEST_NUMBER, SMALLEST_STEP, require_rows

NO_NAMES: Mapping[str, str] = {}
# Span of an angle that is wrapped to one revolution, with the jitter of an encoder at its index [rad].
WRAPPED = 2 * np.pi * 1.001

ONE_TABLE = "a recording has all channels: files of single channels are joined by the group 'signal' of 'path' in a map"


def assemble(
    file: str,
    facts: Mapping,
    columns: Mapping[str, Float[np.ndarray, " time"]],
    names: Mapping[str, str] = NO_NAMES,
    first_row: int = FIRST_ROW,
) -> Recording:
    """A recording of one file, with a continuous angle.

    Parameters
    ----------
    file : str
        Its name in messages.
    facts : mapping
        As :func:`swgsim.recordings.files.facts.parse` returns them.
    columns : mapping
        ``t`` [s] and names of :data:`swgsim.recordings.recording.CHANNELS` to their values.
    names : mapping
        How the file calls them, where it has other names.
    first_row : int
        Row of the file with the first sample.

    Raises
    ------
    FileDefect
        If a number is not finite or the time does not increase, with row and column.
    """
    require_sound(file, columns, names, first_row)
    channels = {name: columns[name] for name in CHANNELS if name in columns}
    if "phi_in" in channels:
        channels["phi_in"] = unwrapped(channels["phi_in"])
    return Recording(
        name=facts["recording"],
        gear=facts["gear"],
        session=facts["session"],
        point=OperatingPoint(facts["n_in_rpm"], facts["T_out_nm"]),
        repeat=facts["repeat"],
        time=columns["t"],
        channels=channels,
        conditions=Conditions(facts["temperature_c"], facts["elapsed_s"]),
        label=facts["label"],
    )


def require_sound(
    file: str,
    columns: Mapping[str, Float[np.ndarray, " time"]],
    names: Mapping[str, str] = NO_NAMES,
    first_row: int = FIRST_ROW,
) -> None:
    """Raise a FileDefect unless there are channels, enough rows, finite numbers and an increasing time."""
    if set(columns) <= {"t"}:
        raise FileDefect(file, "no channel", f"at least one of {', '.join(each.column for each in CHANNELS.values())}")
    require_rows(file, len(columns["t"]))
    for name, values in columns.items():
        bad = no_numbers(values)
        if len(bad):
            expected, column = f"a finite number within {LARGEST_NUMBER:g}", names.get(name, column_of(name))
            found = "no number" if np.isnan(values[bad[0]]) else str(values[bad[0]])
            raise FileDefect(file, found, expected, int(bad[0]) + first_row, column)
    back = standing(columns["t"])
    if len(back):
        found = f"{columns['t'][back[0]]} after {columns['t'][back[0] - 1]}"
        raise FileDefect(file, found, "a time that increases", int(back[0]) + first_row, names.get("t", column_of("t")))


def no_numbers(values: Float[np.ndarray, " time"]) -> Int[np.ndarray, " bad"]:
    """Samples that are not finite or too large for computation."""
    return np.flatnonzero(~(np.abs(values) <= LARGEST_NUMBER))


def standing(time: Float[np.ndarray, " time"]) -> Int[np.ndarray, " bad"]:
    """Samples that are not later than their predecessor."""
    return np.flatnonzero(~(np.diff(time) >= SMALLEST_STEP)) + 1


def require_alike(recordings: Sequence[Recording]) -> None:
    """Raise a FileDefect unless all recordings have different names and the same channels."""
    first, names = recordings[0], set()
    for each in recordings:
        if each.name in names:
            raise FileDefect(f"recording {each.name}", f"the name {shown(each.name)} twice", "different names")
        names.add(each.name)
        if set(each.channels) != set(first.channels):
            found = ", ".join(map(column_of, each.channels))
            expected = f"those of {first.name}: {', '.join(map(column_of, first.channels))}"
            raise FileDefect(f"recording {each.name}", f"the channels {found}", f"{expected}; {ONE_TABLE}")


def column_of(name: str) -> str:
    """The column of a channel, or of the time, in a file."""
    return "t_s" if name == "t" else CHANNELS[name].column


def unwrapped(angle: Float[np.ndarray, " time"]) -> Float[np.ndarray, " time"]:
    """A wrapped angle without its jumps by one revolution [rad]; any other angle unchanged.

    >>> unwrapped(np.array([6.0, 6.2, 0.1])).round(3)
    array([6.   , 6.2  , 6.383])
    """
    steps = np.diff(angle)
    if np.ptp(angle) > WRAPPED or not (np.abs(steps) > np.pi).any():
        return angle
    turns = np.where(np.abs(steps) > np.pi, -np.sign(steps), 0)
    return angle + 2 * np.pi * np.concatenate([[0], np.cumsum(turns)])
