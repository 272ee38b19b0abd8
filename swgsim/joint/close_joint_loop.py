"""The job of scripts/close_loop.py for a robot joint: recordings in, the answer out as a folder."""

import hashlib
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from swgsim.common.files import replacing, require_writable, write_json, write_text
from swgsim.common.numbers import significant
from swgsim.common.outcome import Outcome
from swgsim.effects.library import listed, named
from swgsim.effects.text import as_text
from swgsim.joint.days import days
from swgsim.joint.intake.read import JointFiles, read_joints
from swgsim.joint.intake.source import JointSource
from swgsim.joint.intake.source_file import read_source
from swgsim.joint.judged import Judged
from swgsim.joint.ladder import climb
from swgsim.joint.library import SEARCHED
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Table
from swgsim.joint.remaining import remaining
from swgsim.joint.report import report
from swgsim.joint.split import chosen
from swgsim.joint.term import Term
from swgsim.recordings.checks.defect import Defect, summary
from swgsim.recordings.files.file_defect import read_for

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Column maps of robots.
SOURCES = Path(__file__).parents[2] / "conf" / "sources"


def run(config: Mapping[str, Any], tell: Callable[[str], None] = print) -> Outcome:
    """Write ``report.json``, ``effects.yaml`` and ``page.html`` into the folder ``out``, and print the answer.

    Raises
    ------
    ValueError
        If recordings cannot be used, or a choice is unknown or missing; it says what to do.
    OSError
        If the folder ``out`` cannot be written.
    """
    start = time.perf_counter()
    if config["recordings"] is None:
        raise ValueError("no recordings: give recordings=FOLDER, the files that the source describes")
    kinds = library(config)
    require_writable(Path(config["out"]))
    source = read_source(source_path(config["source"]))
    files = _read("recordings", config["recordings"], source)
    by_folder = config["holdout"] is not None and Path(config["holdout"]).is_dir()
    judging = _read("holdout", config["holdout"], source) if by_folder else None
    defects = (*files.defects, *(judging.defects if judging else ()))
    if defects:
        tell(summary(defects))
    case = chosen(files, judging, config["joint"], config["signal"], config["holdout"], config["without"])
    judged = Judged(climb(case.table, kinds, tell), case.heldout, case.floor)
    tables = judged.table, judged.heldout
    by_day = days(judged.ladder.top, tables)
    lines = remaining([(judged.ladder.top, table) for table in tables])
    said = report(judged, by_day, lines)
    said["split"]["left_out"] = list(case.left_out)
    said["noise_floor_how"] = case.floor_how
    said |= {"defects": [str(defect) for defect in _of(defects, tables)]}
    said["seconds"] = round(time.perf_counter() - start, 1)
    figures = _write(Path(config["out"]), judged, by_day, lines, said)
    tell("\n".join(_lines(said)))
    return Outcome(said, figures, digest((*case.table.recordings, *case.heldout.recordings), config))


def _read(what: str, folder: str, source: JointSource) -> JointFiles:
    with read_for(what, folder):
        return read_joints(Path(folder), source)


def source_path(source: str) -> Path:
    """The file of a source: its own path, or a name of conf/sources.

    Raises
    ------
    ValueError
        If there is none; it lists the names.
    """
    path = Path(source) if Path(source).suffix else SOURCES / f"{source}.yaml"
    if not path.is_file():
        names = ", ".join(sorted(each.stem for each in SOURCES.glob("*.yaml")))
        raise ValueError(
            f"source={source} is no file: choose from {names}, or give the path of your own (docs/joints.md)"
        )
    return path


def library(config: Mapping[str, Any]) -> tuple[type[Term], ...]:
    """The terms that are searched for: those named, or all of the library, and further ones from outside.

    Raises
    ------
    ValueError
        If one is unknown, or is an effect of the gauge chain; it lists the choices.
    """
    known = {kind.name(): kind for kind in SEARCHED}
    searched = list(known) if config["searched"] is None else listed(config["searched"])
    found: list[type[Term]] = []
    for name in (*searched, *listed(config["library"])):
        kind = known.get(name) or (named(name) if ":" in name else None)
        if kind is None or not issubclass(kind, Term):
            raise ValueError(
                f"{name!r} is no effect on a joint; choose from {', '.join(known)}, or give the import path "
                "module:Class of a class derived from swgsim.joint.term.Term"
            )
        found.append(kind)
    return tuple(dict.fromkeys(found))


def digest(recordings: Sequence[JointRecording], config: Mapping[str, Any]) -> str:
    """Sixteen hexadecimal digits that change when a recording or the split does."""
    made = hashlib.sha256(f"{config['joint']} {config['signal']} {config['holdout']} {config['without']}".encode())
    for each in recordings:
        made.update(f"{each.name} {each.joint} {each.session}".encode() + each.time.tobytes())
        for name in sorted(each.signals):
            made.update(name.encode() + each.signals[name].tobytes())
    return made.hexdigest()[:16]


def _of(defects: Sequence[Defect], tables: Sequence[Table]) -> list[Defect]:
    """Findings of the recordings that were used, and of those that were refused."""
    used = {f"{each.name} {each.joint}" for table in tables for each in table.recordings}
    runs = {each.name for table in tables for each in table.recordings}
    return [d for d in defects if d.recording in used or d.recording in runs or d.severity == "refuse"]


def _write(folder: Path, judged: Judged, by_day: Any, lines: Any, said: Mapping[str, Any]) -> dict[str, "Figure"]:
    """Write the answer; every file is complete or absent. Returns the pictures."""
    from swgsim.joint.figures import pictures  # with matplotlib, which takes a second
    from swgsim.joint.joint_page import page

    drawn = pictures(judged, by_day, lines, said)
    html = page(said, [picture for picture, _ in drawn.values()])
    write_json(folder / "report.json", said)
    write_text(folder / "effects.yaml", as_text(judged.ladder.top.terms))
    write_text(folder / "page.html", html)
    for name, (picture, _) in drawn.items():
        with replacing(folder / f"{name}.png") as aside:
            aside.write_bytes(picture.png)
    return {name: each for name, (_, each) in drawn.items()}


def _lines(said: Mapping[str, Any]) -> list[str]:
    """What the command prints."""
    error, unit = said["error"], said["unit"]
    both = {
        when: f"{significant(error[when]['fit'])} {unit}, "
        f"on recordings not seen {significant(error[when]['heldout'])} {unit}"
        for when in ("before", "after")
    }
    floor = significant(said["noise_floor"]) + (f" {unit}" if said["noise_floor"] is not None else "")
    return [
        said["sentence"],
        f"error before   {both['before']}",
        f"error after    {both['after']}",
        f"noise at rest  {floor}",
        f"effects found  {said['lacks'] or 'none'}",
    ]
