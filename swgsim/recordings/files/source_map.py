"""A column map: channel and unit of each column of a foreign file, and the facts that the file lacks."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from swgsim.common.checks import require, require_known, require_one_of
from swgsim.recordings.recording import CHANNELS
from swgsim.storage.labelled_signals import SENSORS
from swgsim.tables.file_defect import shown
from swgsim.tables.plain_file import described, require_names
from swgsim.tables.units import FACTORS, STRAIN, bridge_factor


@dataclass(frozen=True)
class ColumnSource:
    """Column of a channel.

    Attributes
    ----------
    channel : str
        ``t`` or a name of :data:`swgsim.recordings.recording.CHANNELS`.
    column : str
        Column of the table or variable of the file.
    unit : str
        Its unit in the file.
    inverted : bool
        Whether the sign is changed.
    gauge_factor, active_arms : float and int, optional
        Properties of a bridge that is given as strain.
    zero_rad : float
        Zero of the angle: value of the column, in rad and with its sign, where the major axis is at s1.

    Raises
    ------
    ValueError
        If channel or unit is unknown, another channel than the angle has a zero, or a strain has no gauge factor and
        arms.
    """

    channel: str
    column: str
    unit: str
    inverted: bool = False
    gauge_factor: float | None = None
    active_arms: int | None = None
    zero_rad: float = 0.0

    def __post_init__(self) -> None:
        require_known("channels", [self.channel], ["t", *CHANNELS])
        units = [*FACTORS[self._target], *([STRAIN] if self.channel in SENSORS else [])]
        require_known(f"the unit of {self.channel}", [self.unit], units)
        if (self.unit == STRAIN) != (self.gauge_factor is not None and self.active_arms is not None):
            raise ValueError(
                f"{self.channel}: gauge_factor and active_arms belong to a gauge in {STRAIN}, and only there"
            )
        require(self.channel, "zero_rad", self.zero_rad, low=-2 * pi, high=2 * pi)
        if self.zero_rad and self.channel != "phi_in":
            raise ValueError(f"zero_rad of {self.channel} is {self.zero_rad:g}: only phi_in has one, leave it out")
        if self.unit == STRAIN:
            require(self.channel, "gauge_factor", self.gauge_factor, low=0.5, high=300)
            require_one_of(self.channel, "active_arms", self.active_arms, (1, 2, 4))

    @property
    def factor(self) -> float:
        """Factor from the unit of the file to that of the channel."""
        sign = -1.0 if self.inverted else 1.0
        if self.gauge_factor is not None and self.active_arms is not None:
            return sign * bridge_factor(self.gauge_factor, self.active_arms)
        return sign * FACTORS[self._target][self.unit]

    def values(self, column: Float[np.ndarray, " time"]) -> Float[np.ndarray, " time"]:
        """The channel from its column."""
        return column * self.factor - self.zero_rad

    @property
    def _target(self) -> str:
        return "s" if self.channel == "t" else CHANNELS[self.channel].unit


@dataclass(frozen=True)
class SourceMap:
    """A column map (conf/sources/example.yaml).

    Attributes
    ----------
    channels : tuple of ColumnSource
    facts : mapping
        Facts of all files, as in a manifest.
    files : mapping
        Name of a file to its own facts; empty for all files of the folder.
    sampling_rate_hz : float, optional
        Replaces a column with the time [Hz].

    Raises
    ------
    ValueError
        If there is no time or it is given twice, or two channels have the same column.
    """

    channels: tuple[ColumnSource, ...]
    facts: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    sampling_rate_hz: float | None = None

    def __post_init__(self) -> None:
        timed = any(source.channel == "t" for source in self.channels)
        if timed == (self.sampling_rate_hz is not None):
            raise ValueError("a column map needs either the channel t or sampling_rate_hz")
        if self.sampling_rate_hz is not None:
            require("the column map", "sampling_rate_hz", self.sampling_rate_hz, low=1e-3, high=1e9)
        columns = [source.column for source in self.channels]
        for column in columns:
            if columns.count(column) > 1:
                raise ValueError(f"column {column!r} is mapped to two channels: give each another column")


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
    require_names("the column map", config, ["channels", "facts", "files", "sampling_rate_hz"])
    for name in ("channels", "facts", "files"):
        require_names(name, config.get(name, {}))
    for name, entries in (("channels", config.get("channels", {})), ("files", config.get("files", {}))):
        for key, entry in entries.items():
            require_names(f"{key} of {name}", entry)
    choices = ["column", "unit", "inverted", "gauge_factor", "active_arms", "zero_rad"]
    channels = []
    for channel, entry in config.get("channels", {}).items():
        require_known(f"channel {channel}", entry, choices)
        for name, kind in (("column", str), ("unit", str), ("inverted", bool)):
            if not isinstance(entry.get(name, False if kind is bool else None), kind):
                raise ValueError(f"{name} of channel {channel} is {shown(entry.get(name))}, must be a {kind.__name__}")
        channels.append(ColumnSource(channel, **entry))
    return SourceMap(tuple(channels), config.get("facts", {}), config.get("files", {}), config.get("sampling_rate_hz"))
