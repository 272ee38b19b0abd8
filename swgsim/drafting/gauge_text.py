"""The draft of a column map for a test bench with strain gauges."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from swgsim.drafting.clock import ClockDraft
from swgsim.drafting.draft_line import DraftLine
from swgsim.drafting.file_contents import FileContents
from swgsim.drafting.file_names import FileNames
from swgsim.drafting.folder import FolderContents
from swgsim.drafting.motion import unwrapped
from swgsim.drafting.yaml_text import ASK, clock_lines, flow, layout_lines, left_lines, line
from swgsim.recordings.files.facts import KNOWN
from swgsim.tables.endings import is_data
from swgsim.tables.units import FACTORS

ORDER = ("phi_in", "n_in", "T_in", "T_out", "s0", "s1", "s2", "s3", "s4")
# A set speed is meant to so many per cent.
MEANT = 0.005
# What stands in a draft for a set speed or load that was not measured.
UNKNOWN = {"n_in_rpm": 1000, "T_out_nm": 0}


def gauge_lines(
    folder: FolderContents, contents: FileContents, clock: ClockDraft | None, drafted: Sequence[DraftLine],
    names: FileNames, known: Mapping[str, Any],
) -> Iterator[str]:  # fmt: skip
    """The lines of the map in YAML.

    Parameters
    ----------
    folder : FolderContents
    contents : FileContents
        The file that was drafted.
    clock : ClockDraft, optional
    drafted : sequence of DraftLine
    names : FileNames
        What the names of the files say.
    known : mapping
        Facts of the user.
    """
    yield f"# A first column map, drafted from {next(iter(folder.runs))}. Decide the lines with {ASK[2:]}, then read."
    yield from layout_lines(contents, drafted)
    if names.path:
        yield line("path", names.path)
    if clock is None:
        yield line("sampling_rate_hz", 10000, "", "no time was found: the sampling rate")
    yield "channels:" if clock or any(each.active and each.quantity for each in drafted) else "channels: {}"
    yield from clock_lines("t", clock, 2)
    asked: set[str] = set()
    for each in sorted(
        (each for each in drafted if each.quantity in ORDER), key=lambda each: ORDER.index(each.quantity)
    ):
        again = each.active and each.question in asked
        why = f"as above: {each.question}" if again and each.question else each.why
        yield line(each.quantity, each.entry, why, "" if again else each.question, 2, each.active)
        asked.add(each.question)
    yield ""
    yield "# Facts of all recordings; the set speed and load are those that were asked of the bench."
    yield "facts:"
    per_file = {} if names.path else {name: _measured(run, clock, drafted, known) for name, run in folder.runs.items()}
    alone = len(folder.runs) == 1 or not per_file
    measured = _measured(contents, clock, drafted, known)
    for fact in ("gear", "session"):
        if fact not in names.groups:
            yield line(
                fact,
                known.get(fact, "unknown"),
                "given" if fact in known else "",
                f"name of the {fact}" * (fact not in known),
                2,
            )
    for fact in ("n_in_rpm", "T_out_nm"):
        if fact not in names.groups and (alone or fact in known):
            question = (
                "" if fact in known else f"{fact} as it was set; {'the mean' if fact in measured else 'not measured'}"
            )
            yield line(fact, measured.get(fact, UNKNOWN[fact]), "given" if fact in known else "", question, 2)
    if "repeat" not in names.groups and alone:
        yield line("repeat", 1, "", "", 2)
    for fact in KNOWN:
        if fact in known and fact not in ("gear", "session", "n_in_rpm", "T_out_nm", "repeat"):
            yield line(fact, known[fact], "given", "", 2)
    if not alone:
        yield from _files(per_file, known)
    elif not names.path and not is_data(name := next(iter(folder.runs))):
        yield line("files", {name: {}}, "files of this ending are read only if they are named")
    yield from left_lines(drafted, contents, folder.others)


def _files(per_file: Mapping[str, Mapping[str, float]], known: Mapping[str, Any]) -> Iterator[str]:
    """Facts of each file, from its numbers."""
    yield ""
    yield f"files:  {ASK} set speed and load of each file; these are the means"
    points: list[tuple] = []
    for name, measured in per_file.items():
        facts = {fact: measured.get(fact, UNKNOWN[fact]) for fact in ("n_in_rpm", "T_out_nm") if fact not in known}
        points.append(tuple(facts.values()))
        yield f"  {flow(name)}: {flow(facts | {'repeat': points.count(points[-1])})}"


def _measured(
    contents: FileContents, clock: ClockDraft | None, drafted: Sequence[DraftLine], known: Mapping[str, Any]
) -> dict[str, float]:
    """Speed and load of a file: those of the user, else the means; the speed is also the slope of the angle."""
    found: dict[str, float] = {fact: known[fact] for fact in ("n_in_rpm", "T_out_nm") if fact in known}
    own = {each.quantity: each.entry["unit"] for each in drafted if each.active and "unit" in each.entry}
    values = {
        each.quantity: one.values
        for each in drafted
        for one in contents.columns
        if (one.column, one.file) == (each.column.column, each.column.file)
    }
    for fact, channel, target, digits in (("n_in_rpm", "n_in", "rpm", 10), ("T_out_nm", "T_out", "N m", 1)):
        if fact not in found and own.get(channel) in FACTORS[target]:
            found[fact] = _round(abs(float(np.nanmean(values[channel]))) * FACTORS[target][own[channel]], digits)
    if "n_in_rpm" not in found and own.get("phi_in") in FACTORS["rad"] and clock is not None:
        there = np.isfinite(values["phi_in"]) & np.isfinite(clock.time)
        turned = np.ptp(unwrapped(values["phi_in"][there])) * FACTORS["rad"][own["phi_in"]]
        found["n_in_rpm"] = _round(turned / float(np.ptp(clock.time[there])) * 30 / np.pi, 10)
    return found


def _round(mean: float, digits: int) -> float:
    """The round number near a mean, as people ask for one; else the mean."""
    near = round(mean / digits) * digits
    return near if mean and abs(near / mean - 1) < MEANT else float(f"{mean:.3g}")
