"""What the maps of gauges and of joints share: layout, names of files, parts of a recording, and accepted findings."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.common.checks import require, require_integer
from swgsim.tables.clock import Clock
from swgsim.tables.file_defect import shown
from swgsim.tables.layout import KEYS as OF_LAYOUT
from swgsim.tables.layout import Layout, read_layout
from swgsim.tables.measured_column import EACH, MeasuredColumn, text
from swgsim.tables.plain_file import require_names

KEYS = (*OF_LAYOUT, "path", "head", "each", "interleaved", "parts", "accept")
LATEST = 1e9
MOST_INTERLEAVED = 1000
# Nothing can be computed with such numbers.
NEVER_ACCEPTED = ("not_finite", "clock_backwards", "too_short", "too_few_samples", "no_rate")


class Part(NamedTuple):
    """A part of each recording, from and to a time after its start [s], with facts of its own."""

    name: str
    start: float
    stop: float
    facts: Mapping[str, Any] = MappingProxyType({})

    def of(self, time: Float[np.ndarray, " time"]) -> slice:
        """Its samples."""
        first, last = np.searchsorted(time - time[0], [self.start, self.stop])
        return slice(int(first), int(last))


@dataclass(frozen=True)
class TableMap:
    """Entries that both maps have.

    Attributes
    ----------
    layout : Layout
    path : str
        Regular expression of RE2 for the path of a file in its folder, with named groups.
    head : tuple of str
        Regular expressions of RE2 for places in the text before the numbers of a file, with named groups.
    each : str
        Regular expression for the groups, elements of struct arrays, sheets, or contents of a column of a file that are
        recordings.
    of_each : mapping
        Names of the recordings of a file, where ``each`` lists them, with facts of each.
    interleaved : int
        How many signals follow one another in the only column of a file.
    parts : tuple of Part
        Each recording is split into these; not at all if empty.
    accepted : tuple of str
        Kinds of findings that do not refuse a recording, as the user accepts them knowingly.
    """

    layout: Layout = field(default_factory=Layout)
    path: str = ""
    head: tuple[str, ...] = ()
    each: str = ""
    of_each: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    interleaved: int = 1
    parts: tuple[Part, ...] = ()
    accepted: tuple[str, ...] = ()

    def of(self, each: str) -> "TableMap":
        """The map of one of the recordings of a file."""
        rows = tuple((column, said.replace(EACH, each)) for column, said in self.layout.rows)
        return replace(self, layout=replace(self.layout, sheet=self.layout.sheet.replace(EACH, each), rows=rows))


def require_each(table: TableMap, columns: Iterable[MeasuredColumn | Clock]) -> None:
    """Raise a ValueError if a map has ``each`` and no column or sheet that uses it, or the reverse."""
    used = table.of("") != table or any(each.of("") != each for each in columns)
    if bool(table.each) != used:
        given = (
            f"has 'each' and {EACH} in no column or sheet, nor in its own rows"
            if table.each
            else f"has {EACH} and no 'each'"
        )
        raise ValueError(f"the map {given}: write {EACH} where the name of a recording stands")


def read_table_map(config: Mapping[str, Any]) -> TableMap:
    """The entries that both maps have; all others are ignored.

    Raises
    ------
    ValueError
        If an entry has no sense.
    """
    interleaved = config.get("interleaved", 1)
    require_integer("the map", "interleaved", interleaved, 1, MOST_INTERLEAVED)
    parts = config.get("parts", {})
    require_names("parts", parts)
    return TableMap(
        read_layout(config),
        text("path", config["path"]) if "path" in config else "",
        tuple(text("head", each) for each in _listed(config.get("head", []))),
        *_each(config.get("each", "")),
        interleaved,
        tuple(_part(name, limits) for name, limits in parts.items()),
        _kinds(config.get("accept", [])),
    )


def _each(entry: Any) -> tuple[str, Mapping[str, Mapping[str, Any]]]:
    """A pattern for names of recordings; or their names with facts, as a pattern and these."""
    if not isinstance(entry, dict):
        return (text("each", entry) if entry != "" else ""), {}
    facts = {str(name): given or {} for name, given in entry.items()}
    for name, given in facts.items():
        require_names(f"{name} of each", given)
    return "|".join(map(re.escape, facts)), facts


def _part(name: str, entry: Any) -> Part:
    """A part from ``[from, to]``, or from ``{from: ..., to: ..., FACT: ...}``."""
    facts = dict(entry) if isinstance(entry, dict) else {}
    limits = [facts.pop("from", None), facts.pop("to", None)] if facts else entry
    if not isinstance(limits, list) or len(limits) != 2:
        raise ValueError(f"part {name} is {shown(limits)}, must be [from, to] in seconds after the start")
    for edge, value in zip(("start", "end"), limits, strict=True):
        require(f"part {name}", edge, value, low=0, high=LATEST)
    if not limits[0] < limits[1]:
        raise ValueError(f"part {name} ends at {limits[1]} s, must end after its start at {limits[0]} s")
    return Part(text("name of a part", name), float(limits[0]), float(limits[1]), facts)


def _listed(value: Any) -> Sequence[Any]:
    return value if isinstance(value, list) else [value]


def _kinds(value: Any) -> tuple[str, ...]:
    kinds = _listed(value)
    for kind in kinds:
        if text("accept", kind) in NEVER_ACCEPTED:
            raise ValueError(f"accept has {kind!r}, with which nothing can be computed: leave it out")
    return tuple(kinds)
