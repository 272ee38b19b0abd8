"""One joint in one run, before its time is known."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.signal import savgol_filter

from swgsim.joint.intake.places import RunFiles
from swgsim.joint.intake.source import JointColumns, JointSource
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.measured_column import MeasuredColumn
from swgsim.tables.measured_table import MeasuredTable, read_measured
from swgsim.tables.table_map import Part


@dataclass(frozen=True, eq=False)
class Run:
    """Signals of one joint in one run after its start-up, in SI units.

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
        [s]; None if the rate follows from the motion.
    span : float
        Largest minus smallest angle as written [revolutions].
    first_row : int
        Row of the file with the first sample, counted from 1.
    stands : bool
        Whether the path names another joint as the one that moved.
    lost : int
        Rows that were left out, as their readings were lost.
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
    lost: int = 0

    @property
    def label(self) -> str:
        """Name in findings."""
        return f"{self.name} {self.joint.name}"

    def __len__(self) -> int:
        return len(self.signals["q"])

    @property
    def columns(self) -> dict[str, str]:
        """Signal to the name of its column in the files."""
        return {each.quantity: str(each.column) for each in self.joint.signals}


def read_runs(folder: Path, files: RunFiles, source: JointSource, start: bool, reader: LimitedReader) -> list[Run]:
    """All joints of a run, or the joint that the path names, with the others if the source says that they stand.

    Parameters
    ----------
    folder : Path
    files : RunFiles
    source : JointSource
    start : bool
        Whether the run has a start-up, which is cut.
    reader : LimitedReader

    Raises
    ------
    FileDefect
        If a file cannot be read, or its path names a joint that the source does not have.
    """
    moved = [joint for joint in source.joints if files.joint in ("", joint.name)]
    if not moved:
        known = ", ".join(joint.name for joint in source.joints)
        raise FileDefect(files.name, f"the joint {shown(files.joint)}", f"one of {known}")
    joints = source.joints if source.others_stand else moved
    columns = [*(column for joint in joints for column in joint.signals), *source.posture]
    rate = None if source.rate_from_motion else source.rate_hz
    table = read_measured(folder, files.files, columns, source.clock, rate, source.table.layout, reader)
    cut = _start(table, source) if start else 0
    time = None if table.time is None else table.time[cut:] - (0.0 if source.clock else table.time[cut : cut + 1].sum())
    numbers = dict(zip(columns, (values[cut:] for values in table.numbers), strict=True))
    posture = np.array([column.values(numbers[column]) for column in source.posture])
    runs = [
        Run(
            files.name, files.run, files.session, joint,
            _signals(joint, numbers, time),
            posture.reshape(len(source.posture), len(table) - cut),
            time, _span(joint, numbers), cut + table.first_row, joint not in moved, table.lost,
        )
        for joint in joints
    ]  # fmt: skip
    if not start or not source.table.parts:
        return runs
    return [part for run in runs for part in _parts(run, source.table.parts)]


def _signals(
    joint: JointColumns,
    numbers: Mapping[MeasuredColumn, Float[np.ndarray, " time"]],
    time: Float[np.ndarray, " time"] | None,
) -> dict[str, Float[np.ndarray, " time"]]:
    """Signals of a joint by their names; a velocity without a column is the slope of the angle."""
    found = {column.quantity: column.values(numbers[column]) for column in joint.signals}
    if joint.smoothed is not None and time is not None:
        found["omega"] = slope(found["q"], time, joint.smoothed)
    return found


def slope(q: Float[np.ndarray, " time"], time: Float[np.ndarray, " time"], window: float) -> Float[np.ndarray, " time"]:
    """Velocity [rad/s] as the slope of an angle, smoothed by a parabola in each window.

    Parameters
    ----------
    q, time : array (time,)
        [rad], [s], which need not be even.
    window : float
        Length [s].
    """
    if len(q) < 2:
        return np.zeros(len(q))
    with np.errstate(divide="ignore", invalid="ignore"):  # a time that stands has a finding of its own
        rough = np.gradient(q, time)
        step = float(np.median(np.diff(time)))
    length = min(int(window / step) // 2 * 2 + 1 if step > 0 else 1, (len(q) - 1) // 2 * 2 + 1)
    return savgol_filter(rough, length, 2) if length > 2 and np.isfinite(rough).all() else rough


def _parts(run: Run, parts: tuple[Part, ...]) -> Iterator[Run]:
    """The parts of a run, each under its own name; it is also that of the session, so that it can be held out."""
    assert run.time is not None  # a source with parts has a time
    for part in parts:
        chosen = part.of(run.time) if np.isfinite(run.time).all() else slice(None)
        yield replace(
            run,
            name=f"{run.name} {part.name}",
            signals={name: values[chosen] for name, values in run.signals.items()},
            posture=run.posture[:, chosen],
            time=run.time[chosen],
            first_row=run.first_row + int(chosen.start or 0),
        )


def _start(table: MeasuredTable, source: JointSource) -> int:
    """Number of samples to cut at the start."""
    if table.time is None or not source.start_seconds:
        return source.start_samples
    late = np.nan_to_num(table.time - table.time[:1]) >= source.start_seconds
    return max(source.start_samples, int(np.argmax(late)) if late.any() else len(late))


def _span(joint: JointColumns, numbers: Mapping[MeasuredColumn, Float[np.ndarray, " time"]]) -> float:
    """Range of the angle as it is written [revolutions]; 0 if a value is not finite."""
    column = next(column for column in joint.signals if column.quantity == "q")
    values = numbers[column]
    with np.errstate(over="ignore", invalid="ignore"):
        span = float(np.ptp(values)) / column.revolution if len(values) else 0.0
    return span if np.isfinite(span) else 0.0
