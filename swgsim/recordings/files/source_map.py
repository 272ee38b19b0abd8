"""A column map: channel and unit of each column of a foreign file, and the facts that the file lacks."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import pi
from pathlib import Path
from typing import Any

from swgsim.common.checks import require, require_known
from swgsim.recordings.files.facts import KNOWN
from swgsim.recordings.recording import CHANNELS
from swgsim.tables.clock import Clock, read_clock
from swgsim.tables.measured_column import MeasuredColumn, number, read_column
from swgsim.tables.path_pattern import require_pattern
from swgsim.tables.plain_file import described, require_names
from swgsim.tables.table_map import KEYS, TableMap, read_table_map, require_each

SIGNAL = "signal"


@dataclass(frozen=True)
class SourceMap:
    """A column map (conf/sources/example.yaml).

    Attributes
    ----------
    channels : tuple of MeasuredColumn
        Their quantities are names of :data:`swgsim.recordings.recording.CHANNELS`.
    clock : Clock, optional
    facts : mapping
        Facts of all files, as in a manifest.
    files : mapping
        Name of a file to its own facts; empty for all files of the folder.
    sampling_rate_hz : float, optional
        Replaces a clock [Hz].
    table : TableMap
        Layout, path, parts and accepted findings. Groups of the path are facts; the group ``signal`` says which file of
        a recording it is.

    Raises
    ------
    ValueError
        If there is no time or it is given twice, or two channels have the same column.
    """

    channels: tuple[MeasuredColumn, ...]
    clock: Clock | None = None
    facts: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    sampling_rate_hz: float | None = None
    table: TableMap = field(default_factory=TableMap)

    def __post_init__(self) -> None:
        if (self.clock is not None) == (self.sampling_rate_hz is not None):
            raise ValueError("a column map needs either the channel t or sampling_rate_hz")
        if self.sampling_rate_hz is not None:
            require("the column map", "sampling_rate_hz", self.sampling_rate_hz, low=1e-3, high=1e9)
        places = [(each.file, each.column, each.rows) for each in self.channels]
        for place in places:
            if places.count(place) > 1:
                raise ValueError(f"column {place[1]!r} is mapped to two channels: give each another column")
        if self.table.path and self.files:
            raise ValueError("the column map has both path and files: facts come from the path or from files")
        require_pattern(self.table.path, (*KNOWN, SIGNAL))
        for pattern in (self.table.each, *self.table.head):
            require_pattern(pattern, KNOWN)

    def of(self, each: str) -> "SourceMap":
        """The map of one of the recordings of a file."""
        clock = self.clock.of(each) if self.clock else None
        channels = tuple(channel.of(each) for channel in self.channels)
        return replace(self, channels=channels, clock=clock, table=self.table.of(each))

    @property
    def columns(self) -> dict[str, str]:
        """Channel, or ``t``, to the name of its column in the files."""
        found = {each.quantity: str(each.column) for each in self.channels}
        return found | ({"t": " and ".join(map(str, self.clock.columns))} if self.clock else {})


def read_map(path: Path) -> SourceMap:
    """A column map from YAML.

    Raises
    ------
    FileDefect
        If the file is not YAML or has an unknown entry; the choices are listed.
    """
    return described(path, "a column map", "conf/sources/example.yaml", _source_map)


def _source_map(config: Any) -> SourceMap:
    """A column map from plain data."""
    require_names("the column map", config, ("channels", "facts", "files", "sampling_rate_hz", *KEYS))
    for name in ("channels", "facts", "files"):
        require_names(name, config.get(name, {}))
    for key, entry in config.get("files", {}).items():
        require_names(f"{key} of files", entry)
    table = read_table_map(config)
    channels = dict(config.get("channels", {}))
    clock = read_clock(channels.pop("t")) if "t" in channels else None
    require_known("channels", channels, ["t", *CHANNELS])
    columns = tuple(_channel(name, entry, table.interleaved) for name, entry in channels.items())
    rate = number("sampling_rate_hz", config)
    require_each(table, [*columns, *([clock] if clock else [])])
    return SourceMap(columns, clock, config.get("facts", {}), config.get("files", {}), rate, table)


def _channel(name: str, entry: Any, interleaved: int) -> MeasuredColumn:
    """A channel; ``zero_rad`` is what the angle reads, in rad and with its sign, where the major axis is at s1."""
    column = read_column(name, entry, CHANNELS[name].unit, ("zero_rad",), interleaved)
    zero = entry.get("zero_rad", 0.0)
    require(name, "zero_rad", zero, low=-2 * pi, high=2 * pi)
    if zero and name != "phi_in":
        raise ValueError(f"zero_rad of {name} is {zero:g}: only phi_in has one, leave it out")
    return replace(column, offset=column.offset - zero)
