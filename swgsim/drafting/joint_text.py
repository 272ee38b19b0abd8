"""The draft of a source for the logs of a robot."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import PurePosixPath
from typing import Any

from swgsim.drafting.clock import ClockDraft
from swgsim.drafting.draft_line import DraftLine, travels
from swgsim.drafting.file_contents import FileContents
from swgsim.drafting.file_names import FileNames
from swgsim.drafting.folder import FolderContents
from swgsim.drafting.yaml_text import ASK, clock_lines, layout_lines, left_lines, line
from swgsim.joint.recording import PREDICTED

ORDER = ("q", "omega", "T_sensor", "T_motor", "current", "T_rigid")
# A joint stands if it moves by less than this share of its travel in the file that was drafted.
STANDS = 1e-3


def joint_lines(
    folder: FolderContents, contents: FileContents, clock: ClockDraft | None, drafted: Sequence[DraftLine],
    names: FileNames, known: Mapping[str, Any],
) -> Iterator[str]:  # fmt: skip
    """The lines of the source in YAML; parameters as for :func:`swgsim.drafting.gauge_text.gauge_lines`."""
    yield f"# A first source, drafted from {next(iter(folder.runs))}. Decide the lines with {ASK[2:]}, then read."
    yield line("robot", known.get("robot", "my robot"), "", "" if "robot" in known else "its name")
    yield from layout_lines(contents, drafted)
    endings = sorted(
        {
            "".join(PurePosixPath(name).suffixes[-2:]) if name.endswith(".gz") else PurePosixPath(name).suffix
            for name in folder.names
        }
    )
    named = folder.named or len(folder.names) == 1
    yield line("files", list(folder.names) if named else [f"*{ending}" for ending in endings])
    standing = [name for name, run in folder.runs.items() if _stands(run, contents, drafted)]
    if standing:
        yield line("rest", standing, "the angles stand")
    if folder.others and not named:
        yield line("leave_out", list(folder.others), "see below")
    if names.path:
        yield line(
            "path", names.path, "", "" if folder.by_signal else "the session: between sessions something was dismounted"
        )
    elif len(folder.names) > 1:
        yield f"{ASK} each file is a session of its own; 'path' says by a group which were recorded without dismounting"
    yield from clock_lines("time", clock)
    if clock is None:
        if any(each.quantity == "omega" and each.active for each in drafted):
            yield line(
                "rate", "from_motion", "no time was found: the rate is mean velocity over mean step of the angle"
            )
        else:
            yield line("rate_hz", 1000, "", "no time was found: the sampling rate")
    yield ""
    yield "joints:" if any(each.joint for each in drafted) else "joints: {}"
    asked: set[tuple[str, str]] = set()
    joints = dict.fromkeys(each.joint for each in drafted if each.joint)
    for joint in joints:
        own = [_once(each, asked) for each in drafted if each.joint == joint]
        yield from _joint(joint, own, known)
        asked |= {(each.quantity, each.question) for each in own}
    loaded = {each.joint for each in drafted if each.active and each.quantity in PREDICTED}
    if missing := [joint for joint in joints if joint not in loaded]:
        yield f"{ASK} nothing to explain in {', '.join(missing)}: map current, T_motor or T_sensor"
    yield from left_lines(drafted, contents, folder.others)


def _once(each: DraftLine, asked: Collection[tuple[str, str]]) -> DraftLine:
    """A line whose question was asked for another joint already points to it."""
    if each.active and (each.quantity, each.question) in asked:
        return replace(each, question="", why=f"as above: {each.question}" if each.question else each.why)
    return each


def _joint(joint: str, own: Sequence[DraftLine], known: Mapping[str, Any]) -> Iterator[str]:
    """One joint."""
    yield f"  {joint}:"
    for each in own:
        if each.quantity == "gear_ratio":
            yield line("gear_ratio", each.entry["gear_ratio"], each.why, each.question, 4)
    for name in ("gear_ratio", "torque_constant"):
        if name in known and not any(each.quantity == name for each in own):
            yield line(name, known[name], "given", "", 4)
    yield "    signals:"
    signals = sorted((each for each in own if each.quantity in ORDER), key=lambda each: ORDER.index(each.quantity))
    for each in signals:
        yield line(each.quantity, each.entry, each.why, each.question, 6, each.active)
        if each.quantity == "q" and not any(other.quantity == "omega" and other.active for other in signals):
            yield line(
                "omega", {"from": "q", "smoothed_s": 0.05}, "no velocity that fits: the slope of the angle", "", 6
            )


def _stands(run: FileContents, contents: FileContents, drafted: Sequence[DraftLine]) -> bool:
    """Whether all angles of a run stand."""
    usual, found = travels(contents, drafted), travels(run, drafted)
    return bool(found) and all(each < STANDS * max(usual) for each in found)
