"""TDMS files of LabVIEW and its relatives, by nptdms, in the child process: groups of channels."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from nptdms import TdmsChannel, TdmsFile
from nptdms.timestamp import TimestampArray

from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.contents import Contents, Listed, few, short_names

EPOCH = 2_082_844_800  # seconds from the first of 1904, where LabVIEW begins to count, to that of 1970


@contextmanager
def opened(path: Path, file: str, wanted: Sequence[str | int] | None) -> Iterator[Contents]:
    """The channels of a file, by name or as ``group/channel``; those of a waveform have a time base."""
    with TdmsFile.open(path, raw_timestamps=True) as source:
        channels = few((channel for group in source.groups() for channel in group.channels()), file)
        groups = [channel.group_name for channel in channels]
        names = short_names(groups, [channel.name for channel in channels])
        listed = [_listed(name, channel) for name, channel in zip(names, channels, strict=True)]
        others = {f"{channel.group_name}/{channel.name}": place for place, channel in enumerate(channels)}
        yield Contents(
            listed, lambda place: _values(channels[place], file), lambda place: _time(channels[place]), others
        )


def _listed(name: str, channel: TdmsChannel) -> Listed:
    """Kind and unit of a channel, and its waveform: equal ones were recorded at the same times."""
    kind = {"f": channel.dtype.name, "i": channel.dtype.name, "u": channel.dtype.name, "M": "timestamp", "b": "bool"}
    properties = channel.properties
    base = ""
    if _step(channel) > 0:
        started = f", started {properties['wf_start_time']}" if "wf_start_time" in properties else ""
        base = f"{len(channel)} steps of {_step(channel)} s from {_start(channel)} s{started}"
    unit = str(properties.get("unit_string", ""))
    return Listed(name, (len(channel),), kind.get(channel.dtype.kind, "text"), unit, base)


def _values(channel: TdmsChannel, file: str) -> np.ndarray:
    """Numbers with the scaling of the file; timestamps as integers of nanoseconds since 1970."""
    values = channel[:]
    if isinstance(values, TimestampArray):
        parts = np.round(values.second_fractions * (1e9 / 2**64)).astype("i8")
        values = (values.seconds - EPOCH) * 10**9 + parts
    if len(values) != len(channel):
        raise FileDefect(file, f"{len(values)} of {len(channel)} samples", "all of them", column=channel.name)
    return values.astype("u1") if values.dtype == bool else values


def _time(channel: TdmsChannel) -> np.ndarray:
    """Times of a waveform [s]."""
    return _start(channel) + _step(channel) * np.arange(len(channel))


def _step(channel: TdmsChannel) -> float:
    return float(channel.properties.get("wf_increment", 0))


def _start(channel: TdmsChannel) -> float:
    return float(channel.properties.get("wf_start_offset", 0))
