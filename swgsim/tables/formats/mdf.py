"""MDF files of measurements on vehicles (versions 3 and 4), by asammdf, in the child process: groups of channels."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from asammdf import MDF

from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.contents import Contents, Listed, few, short_names

MASTER = "time"  # asammdf's name of the time of a group


class _Channel(NamedTuple):
    """A channel, with the numbers of its group and of itself within it."""

    group: int
    place: int
    channel: Any


@contextmanager
def opened(path: Path, file: str, wanted: Sequence[str | int] | None) -> Iterator[Contents]:
    """The channels of a file, by name or as ``group/channel`` with the name of the group or its number from 0.

    The channels of a group have its time; a value that the file calls invalid becomes NaN.
    """
    with MDF(path) as source:
        found = few(_channels(source), file)
        titles = [getattr(group.channel_group, "acq_name", "") for group in source.groups]  # none in MDF 3
        others = {}
        for place, each in enumerate(found):
            others[f"{each.group}/{each.channel.name}"] = place
            if titles.count(titles[each.group]) == 1:
                others.setdefault(f"{titles[each.group]}/{each.channel.name}", place)
        names = short_names([str(each.group) for each in found], [each.channel.name for each in found])
        listed = [_listed(source, name, each) for name, each in zip(names, found, strict=True)]
        yield Contents(
            listed,
            lambda place: _values(source, found[place], file),
            lambda place: np.asarray(source.get_master(found[place].group), "f8"),
            others,
        )


def _channels(source: MDF) -> Iterator[_Channel]:
    """All channels but the times, which need no name."""
    for group, each in enumerate(source.groups):
        for place, channel in enumerate(each.channels):
            if not (channel.name == MASTER and source.masters_db.get(group) == place):
                yield _Channel(group, place, channel)


def _has_formula(conversion: Any) -> bool:
    """Whether a conversion, or one to which it refers, is a text that is computed."""
    if getattr(conversion, "formula", ""):
        return True
    return any(map(_has_formula, (getattr(conversion, "referenced_blocks", None) or {}).values()))


def _listed(source: MDF, name: str, each: _Channel) -> Listed:
    kind = np.dtype(each.channel.dtype_fmt)
    rows = int(source.groups[each.group].channel_group.cycles_nr)
    unit = each.channel.unit or getattr(each.channel.conversion, "unit", "") or ""
    base = f"that of group {each.group}" if each.group in source.masters_db else ""
    return Listed(name, (rows, *kind.shape), kind.base.name if kind.base.kind in "fiub" else "text", unit, base)


def _values(source: MDF, each: _Channel, file: str) -> np.ndarray:
    """Physical values; numbers stay where the file has texts for them."""
    signal = source.get(group=each.group, index=each.place, raw=True, ignore_invalidation_bits=True)
    values, conversion = signal.samples, each.channel.conversion
    if _has_formula(conversion):
        found, expected = "a conversion by a formula, which would be computed", "numbers: export the converted values"
        raise FileDefect(file, found, expected, column=each.channel.name)
    if conversion:
        values = conversion.convert(values, ignore_value2text_conversions=True)
    invalid = signal.invalidation_bits
    if invalid is not None and np.any(invalid):
        values = np.where(np.asarray(invalid, bool), np.nan, values)
    return values.astype("u1") if values.dtype == bool else values
