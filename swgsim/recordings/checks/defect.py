"""A defect in the numbers of recordings; it is reported and never silently corrected."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

# Whether a defect forbids the use of the recordings.
Severity = Literal["refuse", "warn"]


@dataclass(frozen=True)
class Defect:
    """Finding in one recording.

    Attributes
    ----------
    kind : str
        Short name, such as ``angle_in_degrees``.
    severity : "refuse" or "warn"
    recording : str
        Name of the recording.
    channel : str
        Name of the channel, or ``t`` for the time; empty for defects of no single channel.
    found, expected, remedy : str
    row : int, optional
        First affected row of a CSV file: the header is row 1, the first sample row 2.
    column : str
        How the file calls the channel, if it has another name there.
    """

    kind: str
    severity: Severity
    recording: str
    channel: str
    found: str
    expected: str
    remedy: str
    row: int | None = None
    column: str = ""

    def __str__(self) -> str:
        channel = f"{self.channel} (column {self.column})" if self.column else self.channel
        place = [f"recording {self.recording}", *([channel] if channel else [])]
        place += [f"row {self.row}"] if self.row else []
        return f"{', '.join(place)}: found {self.found}, expected {self.expected}: {self.remedy} [{self.kind}]"


def summary(defects: Sequence[Defect]) -> str:
    """One line for each kind and channel, with the first affected recording and the names of the others."""
    alike: dict[tuple[str, str], list[Defect]] = {}
    for defect in defects:
        alike.setdefault((defect.kind, defect.channel), []).append(defect)
    lines = []
    for first, *others in alike.values():
        names = list(dict.fromkeys(defect.recording for defect in others if defect.recording != first.recording))
        also = f"; also in {len(names)} others: {', '.join(names)}" if names else ""
        lines.append(f"- {first.severity}: {first}{also}")
    return "\n".join(lines)


def accepted(defects: Iterable[Defect], kinds: Sequence[str]) -> tuple[Defect, ...]:
    """Findings of which some kinds only warn, as the user accepts them knowingly.

    Parameters
    ----------
    defects : iterable of Defect
    kinds : sequence of str
        ``accept`` of the map.
    """
    return tuple(
        replace(each, severity="warn", remedy=f"accepted in the map; else {each.remedy}")
        if each.kind in kinds
        else each
        for each in defects
    )


def with_columns(defects: Iterable[Defect], column_of: Callable[[Defect], str]) -> tuple[Defect, ...]:
    """Findings with the names of the columns in the files of the user.

    Parameters
    ----------
    defects : iterable of Defect
    column_of : callable
        The column of a finding's channel; empty if it has none.
    """
    return tuple(replace(each, column=column_of(each)) for each in defects)


def unread_defects(files: Sequence[str], where: str) -> Iterator[Defect]:
    """Finding of files that no entry of a map names."""
    if files:
        more = f" and {len(files) - 1} more" if len(files) > 1 else ""
        yield Defect(
            "not_in_map", "warn", files[0], "", f"{files[0]}{more}, which {where} does not name",
            "an entry for each file", "name them in the map; they were not read",
        )  # fmt: skip
