"""A source: the files of a robot, and the signal of each of their columns."""

from dataclasses import dataclass

from swgsim.common.checks import require, require_integer
from swgsim.joint.intake.column import Column
from swgsim.tables.path_pattern import require_pattern

# Limits of the sampling rate [Hz] and of the cut at the start of a run [s].
SLOWEST, FASTEST = 1e-3, 1e9
LONGEST_START = 1e6


@dataclass(frozen=True)
class JointColumns:
    """One joint.

    Attributes
    ----------
    name : str
    signals : tuple of Column
        With ``q`` and ``omega``.
    gear_ratio : float, optional
    torque_constant : float, optional
        Torque at the output for one ampere [N m/A].
    """

    name: str
    signals: tuple[Column, ...]
    gear_ratio: float | None = None
    torque_constant: float | None = None

    def __post_init__(self) -> None:
        names = [column.quantity for column in self.signals]
        for needed in ("q", "omega"):
            if needed not in names:
                raise ValueError(f"{self.name} has no signal {needed}: angle and velocity of a joint are mandatory")
        columns = [column.column for column in self.signals]
        for column in columns:
            if columns.count(column) > 1:
                raise ValueError(f"column {column!r} is two signals of {self.name}: give each its own")
        for name, value in (("gear_ratio", self.gear_ratio), ("torque_constant", self.torque_constant)):
            if value is not None:
                require(self.name, name, value, low=1e-6, high=1e6)


@dataclass(frozen=True)
class JointSource:
    """A source (docs/joint_recordings.md). A file belongs to the first kind whose patterns it matches.

    Attributes
    ----------
    robot : str
    path : str
        Regular expression of RE2 for the path of a file in its folder, with the groups ``session``, ``run`` and
        optionally ``joint``.
    leave_out, rest, files : tuple of str
        Patterns of ignored files, of files at standstill and of files in motion, with ``*`` and ``?``. They apply to
        the name of a file, or to its path in the folder if the pattern has a slash.
    joints : tuple of JointColumns
    header : bool
        Whether the first row of a CSV file has the names of the columns.
    time : Column, optional
    rate_hz : float, optional
        Sampling rate [Hz]; with ``rate_from_motion`` the expected one.
    rate_from_motion : bool
        Whether the rate of each run is mean velocity over mean step of the angle.
    start_samples, start_seconds : int, float
        Cut at the start of each run in motion.
    posture : tuple of Column
        Angles of all joints from base to tip.
    others_stand : bool
        Whether joints that the path of a file does not name stand still and give the noise of their signals.
    """

    robot: str
    path: str
    files: tuple[str, ...]
    joints: tuple[JointColumns, ...]
    rest: tuple[str, ...] = ()
    leave_out: tuple[str, ...] = ()
    header: bool = True
    time: Column | None = None
    rate_hz: float | None = None
    rate_from_motion: bool = False
    start_samples: int = 0
    start_seconds: float = 0.0
    posture: tuple[Column, ...] = ()
    others_stand: bool = False

    def __post_init__(self) -> None:
        require_pattern(self.path)
        if not self.files:
            raise ValueError("files is empty, must name the files in motion, such as '*.csv'")
        if not self.joints:
            raise ValueError("joints is empty, must name at least one joint")
        if self.time is not None and (self.rate_hz is not None or self.rate_from_motion):
            raise ValueError("the source has both time and a rate: keep the one that was measured")
        if self.time is None and self.rate_hz is None and not self.rate_from_motion:
            raise ValueError("the source has no time: give a column 'time', or 'rate_hz', or 'rate: from_motion'")
        if self.rate_hz is not None:
            require("the source", "rate_hz", self.rate_hz, low=SLOWEST, high=FASTEST)
        require_integer("start_up", "samples", self.start_samples, 0, 10**9)
        require("start_up", "seconds", self.start_seconds, low=0, high=LONGEST_START)
        if self.start_seconds and self.rate_from_motion:
            raise ValueError("start_up is in seconds, but the rate comes from the motion after it: give it in samples")
        for column in self.columns:
            if isinstance(column.column, int) == self.header:
                expected = "its name" if self.header else "its number from 1, as the files have no header"
                raise ValueError(f"column {column.column!r} of {column.quantity} must be {expected}")

    @property
    def columns(self) -> tuple[Column, ...]:
        """All columns that are read from a file."""
        time = (self.time,) if self.time else ()
        return (*time, *(column for joint in self.joints for column in joint.signals), *self.posture)
