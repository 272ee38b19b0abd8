"""A source: the files of a robot, and the signal of each of their columns."""

from dataclasses import dataclass, field, replace

from swgsim.common.checks import require, require_integer
from swgsim.tables.clock import Clock
from swgsim.tables.measured_column import MeasuredColumn
from swgsim.tables.path_pattern import require_pattern
from swgsim.tables.table_map import TableMap, require_each

# Limits of the sampling rate [Hz] and of the cut at the start of a run [s].
SLOWEST, FASTEST = 1e-3, 1e9
LONGEST_START = 1e6
GROUPS = ("session", "run", "joint", "signal")


@dataclass(frozen=True)
class JointColumns:
    """One joint.

    Attributes
    ----------
    name : str
    signals : tuple of MeasuredColumn
        With ``q``, and with ``omega`` unless that comes from the angle.
    gear_ratio : float, optional
    torque_constant : float, optional
        Torque at the output for one ampere [N m/A].
    smoothed : float, optional
        Length of the window in which the velocity is the slope of the angle [s]; None for a velocity with a column.
    """

    name: str
    signals: tuple[MeasuredColumn, ...]
    gear_ratio: float | None = None
    torque_constant: float | None = None
    smoothed: float | None = None

    def __post_init__(self) -> None:
        names = [column.quantity for column in self.signals]
        if "q" not in names:
            raise ValueError(f"{self.name} has no signal q: the angle of a joint is mandatory")
        if "omega" not in names and self.smoothed is None:
            raise ValueError(
                f"{self.name} has no signal omega: map the velocity, or take it from the angle by "
                "omega: {from: q, smoothed_s: 0.05}"
            )
        places = [(column.file, column.column, column.rows) for column in self.signals]
        for place in places:
            if places.count(place) > 1:
                raise ValueError(f"column {place[1]!r} is two signals of {self.name}: give each its own")
        for name, value in (("gear_ratio", self.gear_ratio), ("torque_constant", self.torque_constant)):
            if value is not None:
                require(self.name, name, value, low=1e-6, high=1e6)
        if self.smoothed is not None:
            require(f"omega of {self.name}", "smoothed_s", self.smoothed, low=1e-4, high=10)


@dataclass(frozen=True)
class JointSource:
    """A source (docs/joint_recordings.md). A file belongs to the first kind whose patterns it matches.

    Attributes
    ----------
    robot : str
    files, rest, leave_out : tuple of str
        Patterns of files in motion, of files at standstill and of ignored files, with ``*`` and ``?``. They apply to
        the name of a file, or to its path in the folder if the pattern has a slash.
    joints : tuple of JointColumns
    table : TableMap
        Layout, path, parts and accepted findings. The path has the groups :data:`GROUPS`.
    clock : Clock, optional
    rate_hz : float, optional
        Sampling rate [Hz]; with ``rate_from_motion`` the expected one.
    rate_from_motion : bool
        Whether the rate of each run is mean velocity over mean step of the angle.
    start_samples, start_seconds : int, float
        Cut at the start of each run in motion.
    posture : tuple of MeasuredColumn
        Angles of all joints from base to tip.
    others_stand : bool
        Whether joints that the path of a file does not name stand still and give the noise of their signals.
    """

    robot: str
    files: tuple[str, ...]
    joints: tuple[JointColumns, ...]
    rest: tuple[str, ...] = ()
    leave_out: tuple[str, ...] = ()
    table: TableMap = field(default_factory=TableMap)
    clock: Clock | None = None
    rate_hz: float | None = None
    rate_from_motion: bool = False
    start_samples: int = 0
    start_seconds: float = 0.0
    posture: tuple[MeasuredColumn, ...] = ()
    others_stand: bool = False

    def __post_init__(self) -> None:
        require_pattern(self.table.path, GROUPS)
        for pattern in (self.table.each, *self.table.head):
            require_pattern(pattern, GROUPS[:3])
        require_each(self.table, [*self.columns, *([self.clock] if self.clock else [])])
        if not self.files:
            raise ValueError("files is empty, must name the files in motion, such as '*.csv'")
        if not self.joints:
            raise ValueError("joints is empty, must name at least one joint")
        if self.clock is not None and (self.rate_hz is not None or self.rate_from_motion):
            raise ValueError("the source has both time and a rate: keep the one that was measured")
        if self.clock is None and self.rate_hz is None and not self.rate_from_motion:
            raise ValueError("the source has no time: give a column 'time', or 'rate_hz', or 'rate: from_motion'")
        if self.rate_hz is not None:
            require("the source", "rate_hz", self.rate_hz, low=SLOWEST, high=FASTEST)
        require_integer("start_up", "samples", self.start_samples, 0, 10**9)
        require("start_up", "seconds", self.start_seconds, low=0, high=LONGEST_START)
        if self.rate_from_motion and self.start_seconds:
            raise ValueError("start_up is in seconds, but the rate comes from the motion after it: give it in samples")
        if any(part.facts for part in self.table.parts):
            raise ValueError("a part of a joint log has facts: it is a run and a session of its own, leave them out")
        if self.rate_from_motion and (self.table.parts or any(joint.smoothed for joint in self.joints)):
            raise ValueError("parts and a velocity from the angle need a time: give 'time' or 'rate_hz', and no 'rate'")
        for column in self.columns:
            if not self.table.layout.named and not isinstance(column.place, int):
                where = f"column {column.column!r} of {column.quantity}"
                raise ValueError(f"{where} must be its number from 1, as the files have no header")

    def of(self, each: str) -> "JointSource":
        """The source of one of the recordings of a file."""
        joints = tuple(
            replace(joint, signals=tuple(signal.of(each) for signal in joint.signals)) for joint in self.joints
        )
        clock = self.clock.of(each) if self.clock else None
        posture = tuple(column.of(each) for column in self.posture)
        table = replace(self.table.of(each), each="")
        return replace(self, joints=joints, clock=clock, posture=posture, table=table)

    @property
    def columns(self) -> tuple[MeasuredColumn, ...]:
        """All columns that are read from a run, without those of the time."""
        return (*(column for joint in self.joints for column in joint.signals), *self.posture)
