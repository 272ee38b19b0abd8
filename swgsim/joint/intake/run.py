"""One joint in one file, before its time is known."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from swgsim.joint.intake.column import Column
from swgsim.joint.intake.source import JointColumns, JointSource
from swgsim.joint.intake.table import Columns, read_table
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.path_pattern import path_groups


@dataclass(frozen=True, eq=False)
class Run:
    """Signals of one joint in one file after its start-up, in SI units.

    Attributes
    ----------
    file : str
        Path in the folder.
    name, session : str
    joint : JointColumns
    signals : mapping
        Name of :data:`swgsim.joint.recording.SIGNALS` to array (time,); a wrapped angle is unwrapped.
    posture : array (joint, time)
        [rad]; of zero joints if the source has no posture.
    time : array (time,), optional
        [s].
    span : float
        Largest minus smallest angle as written [revolutions].
    first_row : int
        Row of the file with the first sample, counted from 1.
    stands : bool
        Whether the path names another joint as the one that moved.
    """

    file: str
    name: str
    session: str
    joint: JointColumns
    signals: Mapping[str, Float[np.ndarray, " time"]]
    posture: Float[np.ndarray, "joint time"]
    time: Float[np.ndarray, " time"] | None
    span: float
    first_row: int
    stands: bool = False

    @property
    def label(self) -> str:
        """Name in findings."""
        return f"{self.name} {self.joint.name}"

    def __len__(self) -> int:
        return len(self.signals["q"])


def read_runs(folder: Path, name: str, source: JointSource, start: bool) -> list[Run]:
    """All joints of a file, or the joint that the path names, with the others if the source says that they stand.

    Parameters
    ----------
    folder : Path
    name : str
        Path in the folder.
    source : JointSource
    start : bool
        Whether the run has a start-up, which is cut.

    Raises
    ------
    FileDefect
        If the file cannot be read, or its path names a joint that the source does not have.
    """
    groups = path_groups(source.path, name)
    moved = [joint for joint in source.joints if groups.get("joint", joint.name) == joint.name]
    if not moved:
        known = ", ".join(joint.name for joint in source.joints)
        raise FileDefect(name, f"the joint {shown(groups['joint'])}", f"one of {known}")
    joints = source.joints if source.others_stand else moved
    signals = [column for joint in joints for column in joint.signals]
    times = [source.time] if source.time else []
    wanted = [column.column for column in [*times, *signals, *source.posture]]
    table = read_table(folder / name, name, wanted, source.header)
    lengths = {column: len(values) for column, values in table.items()}
    if len(set(lengths.values())) > 1:
        raise FileDefect(name, f"columns of different lengths {lengths}", "as many values of every signal")
    cut = _start(table, source) if start else 0
    table = {column: values[cut:] for column, values in table.items()}
    time = _values(table, source.time) if source.time else None
    posture = np.empty((len(source.posture), min(len(values) for values in table.values())))
    for row, column in zip(posture, source.posture, strict=True):
        row[:] = _values(table, column)
    first_row = cut + (2 if source.header else 1)
    return [
        Run(
            name, groups["run"], groups["session"], joint,
            {column.quantity: _values(table, column) for column in joint.signals},
            posture, time, _span(table, joint), first_row, joint not in moved,
        )
        for joint in joints
    ]  # fmt: skip


def _start(table: Columns, source: JointSource) -> int:
    """Number of samples to cut at the start."""
    if source.time:
        late = np.diff(_values(table, source.time), prepend=np.nan)
        late = np.cumsum(np.nan_to_num(late)) >= source.start_seconds
        by_seconds = int(np.argmax(late)) if late.any() else len(late)
    else:
        by_seconds = round(source.start_seconds * (source.rate_hz or 0))
    return max(source.start_samples, by_seconds)


def _values(table: Columns, column: Column) -> Float[np.ndarray, " time"]:
    """One signal in its unit."""
    values = table[column.column]
    # Numbers that are not finite have a finding.
    with np.errstate(over="ignore", invalid="ignore"):
        if column.wraps and np.isfinite(values).all():
            values = np.unwrap(values, period=column.revolution)
        return values * column.factor


def _span(table: Columns, joint: JointColumns) -> float:
    """Range of the angle as it is written [revolutions]; 0 if a value is not finite."""
    column = next(column for column in joint.signals if column.quantity == "q")
    values = table[column.column]
    with np.errstate(over="ignore", invalid="ignore"):
        span = float(np.ptp(values)) / column.revolution if len(values) else 0.0
    return span if np.isfinite(span) else 0.0
