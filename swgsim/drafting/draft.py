"""From files to the draft of a map: look, understand, write, and read it back."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from swgsim.common.checks import require_known
from swgsim.drafting.clock import ClockDraft, drafted_clock
from swgsim.drafting.file_names import FileNames, fact_names, run_names, signals_path
from swgsim.drafting.folder import LookedAt, look_at
from swgsim.drafting.gauge_channels import gauge_channels
from swgsim.drafting.gauge_text import gauge_lines
from swgsim.drafting.joint_signals import joint_signals
from swgsim.drafting.joint_text import joint_lines
from swgsim.drafting.map_draft import MapDraft
from swgsim.drafting.motion import unwrapped
from swgsim.drafting.named import Named
from swgsim.drafting.order_2 import has_order_2
from swgsim.drafting.own_times import own_times
from swgsim.drafting.seen import Seen
from swgsim.drafting.seen_column import SeenColumn
from swgsim.drafting.taken import Taken, travels
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
    looked = look_at(paths)
    kind = kind or _kind(next(iter(looked.runs.values())), given)
    names = _names(looked, kind)
    seen = next(iter(looked.runs.values()))
    clock, taken = _understood(seen, kind, given | _facts(names, looked, seen))
    moving = _most_moving(looked, taken)
    if moving is not seen:
        seen = moving
        clock, taken = _understood(seen, kind, given | _facts(names, looked, seen))
    lines = gauge_lines if kind == GAUGES else joint_lines
    text = "\n".join(lines(looked, seen, clock, taken, names, given)) + "\n"
    own = looked.folder if kind == JOINTS or len(paths) > 1 else paths[0]
    findings, readable = read_back(text, own, kind)
    return MapDraft(kind, own, text, tuple(taken), clock, findings, readable)


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


def _kind(seen: Seen, known: Mapping[str, Any]) -> str:
    """Gauges if a column is one by its name, its unit or its numbers, or if what is known is of gauges; else joints."""
    quantities = {meaning_of(each).quantity for each in seen.columns}
    if "gauge" in quantities or set(known) & set(OF_GAUGES):
        return GAUGES
    # Two lobes that pass a gauge in each of many revolutions are those of a wave generator.
    _, taken = _understood(seen, JOINTS, known)
    for each in taken:
        if each.quantity == "q" and each.entry["unit"] in FACTORS["rad"]:
            angle = unwrapped(each.column.values) * FACTORS["rad"][each.entry["unit"]]
            others = [other.column for other in taken if not other.quantity and not other.column.is_text]
            if np.ptp(angle) > TURNED and any(has_order_2(other, angle) for other in others):
                return GAUGES
    return JOINTS


def _names(looked: LookedAt, kind: str) -> FileNames:
    if looked.by_signal:
        return signals_path(looked.names, kind)
    if kind == JOINTS:
        return run_names(looked.names)
    # A path would also mean other files of the folder.
    return FileNames("", ()) if looked.named and len(looked.names) > 1 else fact_names(looked.names)


def _facts(names: FileNames, looked: LookedAt, seen: Seen) -> dict[str, str]:
    """Facts that the name of the drafted file says."""
    file = next(name for name, run in looked.runs.items() if run is seen)
    return (path_groups(names.path, file) or {}) if names.path else {}


def _understood(seen: Seen, kind: str, known: Mapping[str, Any]) -> tuple[ClockDraft | None, list[Taken]]:
    """The time, and what each other column is taken for."""
    clock = drafted_clock([Named(each, meaning_of(each)) for each in seen.columns])
    columns, others = own_times(seen.columns, clock) if clock else (seen.columns, [])
    columns, repeated = _first_of_their_name(columns)
    again = [Taken(each, "", why="the name again: of another recording?") for each in repeated]
    named = [Named(each, meaning_of(each)) for each in columns]
    channels = gauge_channels if kind == GAUGES else joint_signals
    if clock is None:
        return None, [*channels(named, None, known), *again]
    of_time = [Taken(each, "t", clock.entry, clock.why, clock.question) for each in clock.columns]
    of_time += [Taken(each, "t", why="of the columns after it", active=False) for each in others]
    return clock, [*of_time, *channels(named, clock.time, known), *again]


def _first_of_their_name(columns: Sequence[SeenColumn]) -> tuple[list[SeenColumn], list[SeenColumn]]:
    """The columns, and those whose name an earlier one has: recordings may stand side by side."""
    first: dict[tuple[str, str, str], SeenColumn] = {}
    for place, each in enumerate(columns):
        first.setdefault((each.name or str(place), each.unit, each.file), each)
    kept = list(first.values())
    return kept, [each for each in columns if each not in kept]


def _most_moving(looked: LookedAt, taken: Sequence[Taken]) -> Seen:
    """The run in which the angles move most, in which units and velocities show best."""
    return max(looked.runs.values(), key=lambda run: sum(travels(run, taken)))
