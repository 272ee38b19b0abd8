"""From files to the draft of a map: look, understand, write, and read it back."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from swgsim.common.checks import require_known
from swgsim.drafting.clock import ClockDraft, drafted_clock
from swgsim.drafting.draft_line import DraftLine, travels
from swgsim.drafting.file_column import FileColumn
from swgsim.drafting.file_contents import FileContents
from swgsim.drafting.file_names import FileNames, fact_names, run_names, signals_path
from swgsim.drafting.folder import FolderContents, folder_contents
from swgsim.drafting.gauge_channels import gauge_channels
from swgsim.drafting.gauge_text import gauge_lines
from swgsim.drafting.joint_signals import joint_signals
from swgsim.drafting.joint_text import joint_lines
from swgsim.drafting.map_draft import MapDraft
from swgsim.drafting.motion import unwrapped
from swgsim.drafting.named_column import NamedColumn
from swgsim.drafting.order_2 import has_order_2
from swgsim.drafting.own_times import own_times
from swgsim.drafting.words import meaning_of
from swgsim.joint.intake.read import read_joints
from swgsim.recordings.checks.defect import summary
from swgsim.recordings.read import inspect_recordings
from swgsim.tables.path_pattern import path_groups
from swgsim.tables.units import FACTORS

GAUGES, JOINTS = "gauges", "joints"
# Facts that a user may give, as they are in no column.
OF_GAUGES = (
    "gear", "session", "n_in_rpm", "T_out_nm", "repeat", "temperature_c", "elapsed_s", "label", "gauge_factor",
    "active_arms", "full_scale",
)  # fmt: skip
# Angle of a wave generator in a recording [rad]; robots turn less.
TURNED = 6 * np.pi
OF_JOINTS = ("robot", "gear_ratio", "torque_constant", "rated")


def draft_map(
    path: str | Path | Sequence[str | Path], kind: str | None = None, known: Mapping[str, Any] | None = None
) -> MapDraft:
    """Draft a column map or a source by looking at files.

    Parameters
    ----------
    path : str, Path or sequence of them
        A folder, a file, or several files.
    kind : {"gauges", "joints"}, optional
        Recordings of a test bench with strain gauges, or logs of a robot; by default it is guessed.
    known : mapping, optional
        Facts that are in no file, such as ``{"gear": "A17", "gauge_factor": 2.0, "active_arms": 4}`` or
        ``{"gear_ratio": 101}``.

    Returns
    -------
    MapDraft
        A guess: read it before you use it.

    Raises
    ------
    ValueError
        If there is no table of numbers, or a choice is unknown.
    """
    given = dict(known or {})
    require_known("known", given, [*OF_GAUGES, *OF_JOINTS])
    if kind is not None:
        require_known("the kind", [kind], [GAUGES, JOINTS])
    paths = [Path(each) for each in ([path] if isinstance(path, str | Path) else path)]
    folder = folder_contents(paths)
    kind = kind or _kind(next(iter(folder.runs.values())), given)
    names = _names(folder, kind)
    contents = next(iter(folder.runs.values()))
    clock, drafted = _understood(contents, kind, given | _facts(names, folder, contents))
    moving = _most_moving(folder, drafted)
    if moving is not contents:
        contents = moving
        clock, drafted = _understood(contents, kind, given | _facts(names, folder, contents))
    lines = gauge_lines if kind == GAUGES else joint_lines
    text = "\n".join(lines(folder, contents, clock, drafted, names, given)) + "\n"
    own = folder.folder if kind == JOINTS or len(paths) > 1 else paths[0]
    findings, readable = read_back(text, own, kind)
    return MapDraft(kind, own, text, tuple(drafted), clock, findings, readable)


def read_back(text: str, path: Path, kind: str) -> tuple[str, bool]:
    """What the reading says of a draft, its findings or why it refuses, and whether it read a usable recording."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "draft.yaml"
        file.write_text(text, encoding="utf-8")
        try:
            if kind == GAUGES:
                found = inspect_recordings(path, file)
                text = f"{len(found) or 'no'} recordings are read"
                return "\n".join([text, summary(found.defects)]).strip(), len(found) > 0
            read = read_joints(path, file)
            return "\n".join([repr(read), read.findings()]).strip(), len(read.recordings) > 0
        except ValueError as error:
            return str(error).replace(f"{file}: ", "").replace(str(file), "the draft"), False


def _kind(contents: FileContents, known: Mapping[str, Any]) -> str:
    """Gauges if a column is one by its name, its unit or its numbers, or if what is known is of gauges; else joints."""
    quantities = {meaning_of(each).quantity for each in contents.columns}
    if "gauge" in quantities or set(known) & set(OF_GAUGES):
        return GAUGES
    # Two lobes that pass a gauge in each of many revolutions are those of a wave generator.
    _, drafted = _understood(contents, JOINTS, known)
    for each in drafted:
        if each.quantity == "q" and each.entry["unit"] in FACTORS["rad"]:
            angle = unwrapped(each.column.values) * FACTORS["rad"][each.entry["unit"]]
            others = [other.column for other in drafted if not other.quantity and not other.column.is_text]
            if np.ptp(angle) > TURNED and any(has_order_2(other, angle) for other in others):
                return GAUGES
    return JOINTS


def _names(folder: FolderContents, kind: str) -> FileNames:
    if folder.by_signal:
        return signals_path(folder.names, kind)
    if kind == JOINTS:
        return run_names(folder.names)
    # A path would also mean other files of the folder.
    return FileNames("", ()) if folder.named and len(folder.names) > 1 else fact_names(folder.names)


def _facts(names: FileNames, folder: FolderContents, contents: FileContents) -> dict[str, str]:
    """Facts that the name of the drafted file says."""
    file = next(name for name, run in folder.runs.items() if run is contents)
    return (path_groups(names.path, file) or {}) if names.path else {}


def _understood(
    contents: FileContents, kind: str, known: Mapping[str, Any]
) -> tuple[ClockDraft | None, list[DraftLine]]:
    """The time, and what each other column is taken for."""
    clock = drafted_clock([NamedColumn(each, meaning_of(each)) for each in contents.columns])
    columns, others = own_times(contents.columns, clock) if clock else (contents.columns, [])
    columns, repeated = _first_of_their_name(columns)
    again = [DraftLine(each, "", why="the name again: of another recording?") for each in repeated]
    named = [NamedColumn(each, meaning_of(each)) for each in columns]
    channels = gauge_channels if kind == GAUGES else joint_signals
    if clock is None:
        return None, [*channels(named, None, known), *again]
    of_time = [DraftLine(each, "t", clock.entry, clock.why, clock.question) for each in clock.columns]
    of_time += [DraftLine(each, "t", why="of the columns after it", active=False) for each in others]
    return clock, [*of_time, *channels(named, clock.time, known), *again]


def _first_of_their_name(columns: Sequence[FileColumn]) -> tuple[list[FileColumn], list[FileColumn]]:
    """The columns, and those whose name an earlier one has: recordings may stand side by side."""
    first: dict[tuple[str, str, str], FileColumn] = {}
    for place, each in enumerate(columns):
        first.setdefault((each.name or str(place), each.unit, each.file), each)
    kept = list(first.values())
    return kept, [each for each in columns if each not in kept]


def _most_moving(folder: FolderContents, drafted: Sequence[DraftLine]) -> FileContents:
    """The run in which the angles move most, in which units and velocities show best."""
    return max(folder.runs.values(), key=lambda run: sum(travels(run, drafted)))
