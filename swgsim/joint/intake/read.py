"""Reading of joint recordings: files through a source, with the findings on their numbers."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np

from swgsim.joint.intake.findings import (
    at_rest_findings,
    duplicate_findings,
    moving_findings,
    unusable,
    wrap_findings,
)
from swgsim.joint.intake.places import RunFiles, places
from swgsim.joint.intake.run import Run, read_runs
from swgsim.joint.intake.scale import clock_findings, measured_rates, no_rate, rate_findings, usual_rates
from swgsim.joint.intake.signals import gap_findings
from swgsim.joint.intake.source import JointSource
from swgsim.joint.intake.source_file import read_source
from swgsim.joint.recording import SIGNALS, JointRecording
from swgsim.recordings.checks.defect import Defect, accepted, summary, unread_defects, with_columns
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.head_facts import head_facts
from swgsim.tables.several import recordings_in


@dataclass(frozen=True, repr=False)
class JointRecordings:
    """Recordings of a folder, with the findings on them.

    Attributes
    ----------
    recordings, at_rest : tuple of JointRecording
        Usable recordings in motion and at standstill, in the order of session, name and joint.
    defects : tuple of Defect
        All findings; a recording with a finding that refuses it is in none of the other fields.
    standing : tuple of JointRecording
        Joints that stood while the joint in the path of their file moved; they show the noise of their signals.
    refused : tuple of (str, str, str)
        Session, run and joint of every refused recording in motion.
    folder : Path
    """

    recordings: tuple[JointRecording, ...]
    at_rest: tuple[JointRecording, ...]
    defects: tuple[Defect, ...]
    standing: tuple[JointRecording, ...] = ()
    refused: tuple[tuple[str, str, str], ...] = ()
    folder: Path = Path()

    def __repr__(self) -> str:
        robots = ", ".join(sorted({each.robot for each in self.recordings}))
        count = f"{len(self.recordings)} joint recordings of {robots}" if robots else "no usable joint recordings"
        lines = [f"{count} in {self.folder}"]
        for name in sorted({each.joint for each in self.recordings}):
            own = [each for each in self.recordings if each.joint == name]
            sessions = sorted({each.session for each in own})
            signals = [signal for signal in SIGNALS if any(signal in each.signals for each in own)]
            lines.append(f"  {name}: {len(own)} runs of sessions {', '.join(sessions)}; signals {', '.join(signals)}")
        lines.append(f"  at rest: {len(self.at_rest)}; refused: {len(self.refused)}; findings: {len(self.defects)}")
        return "\n".join(lines)

    def findings(self, joint: str | None = None) -> str:
        """The findings as text, one line for each kind and channel; without those of other joints if one is chosen."""
        joints = {each.joint for each in self.recordings} | {each for _, _, each in self.refused}
        others = tuple(f" {each}" for each in joints - {joint}) if joint in joints else ()
        return summary([each for each in self.defects if not each.recording.endswith(others)])

    def require_usable(self) -> None:
        """Raise a ValueError if every recording was refused; it names the most frequent reason."""
        if not self.recordings:
            kinds = Counter(each.kind for each in self.defects if each.severity == "refuse")
            kind, number = kinds.most_common(1)[0] if kinds else ("no file in motion", 0)
            first = next((str(each) for each in self.defects if each.kind == kind), "")
            count = f"all {len(self.refused)} recordings in {self.folder} were refused"
            raise ValueError(f"{count}, {number} of them for {kind}: {first}")


def read_joints(folder: Path, source: JointSource | Path) -> JointRecordings:
    """Read the recordings of the joints of a robot.

    Parameters
    ----------
    folder : Path
    source : JointSource or Path
        As :func:`swgsim.joint.intake.source_file.read_source` reads it, or its file.

    Raises
    ------
    FileDefect
        If source and files do not agree, or a file cannot be read.
    """
    source = read_source(source) if isinstance(source, Path) else source
    found = places(folder, source)
    with LimitedReader() as reader:
        in_motion = [run for files in found.moving for run in _read_each(folder, files, source, True, reader)]
        resting = [run for files in found.resting for run in _read_each(folder, files, source, False, reader)]
    every = moving = [run for run in in_motion if not run.stands]
    # Standing joints only give noise: one that is unusable or moves is left out without a finding.
    standing = [run for run in in_motion if run.stands and not any(chain(unusable(run), at_rest_findings(run)))]
    _require_unique([*moving, *resting])
    defects = [*unread_defects(found.unmatched, "the source")]
    defects += [defect for run in [*moving, *resting] for defect in chain(unusable(run), wrap_findings(run))]
    refused = {defect.recording for defect in defects}
    moving, resting = ([run for run in runs if run.label not in refused] for runs in (moving, resting))
    measured = measured_rates(moving) if source.rate_from_motion else {}
    usual = usual_rates([*moving, *resting], measured, source)
    if source.rate_from_motion and not usual:
        defects += [no_rate(run) for run in [*moving, *resting]]
        return JointRecordings((), (), tuple(defects), (), _names(every), folder)
    if source.rate_from_motion:
        defects += rate_findings(moving, measured, source)
    else:
        defects += [defect for run in moving for defect in clock_findings(run, source.rate_hz)]
    recordings = [_recording(run, usual | measured, source.robot) for run in moving]
    at_rest = [_recording(run, usual, source.robot) for run in resting]
    for run, recording in zip(moving, recordings, strict=True):
        defects += moving_findings(run, recording)
    defects += [defect for run in {run.name: run for run in moving}.values() for defect in gap_findings(run)]
    defects += [defect for run in resting for defect in at_rest_findings(run)]
    defects += duplicate_findings([*moving, *resting])
    columns = {run.label: run.columns for run in every} | {run.label: run.columns for run in resting}
    named = with_columns(defects, lambda defect: columns.get(defect.recording, {}).get(defect.channel, ""))
    defects = list(accepted(named, source.table.accepted))
    refused |= {defect.recording for defect in defects if defect.severity == "refuse"}
    return JointRecordings(
        _kept(moving, recordings, refused),
        _kept(resting, at_rest, refused),
        tuple(defects),
        tuple(_recording(run, usual | measured, source.robot) for run in standing),
        _names([run for run in every if {run.label, run.name} & refused]),
        folder,
    )


def _read_each(folder: Path, files: RunFiles, source: JointSource, start: bool, reader: LimitedReader) -> Iterator[Run]:
    """The runs of one file, or the one of several."""
    files = _known(files, head_facts(folder / files.name, files.name, source.table))
    if not source.table.each:
        yield from read_runs(folder, files, source, start, reader)
        return
    for each, groups in recordings_in(folder / files.name, files.name, source.table, reader):
        one = _known(files, {"run": f"{files.run} {each}", **groups})
        yield from read_runs(folder, one, source.of(each), start, reader)


def _known(files: RunFiles, facts: Mapping[str, str]) -> RunFiles:
    """The files with what is known of their session, run and joint."""
    session, run, joint = (facts.get(name, getattr(files, name)) for name in ("session", "run", "joint"))
    return files._replace(session=session, run=run, joint=joint)


def _recording(run: Run, rates: Mapping[str, float], robot: str) -> JointRecording:
    """A run with its time, which begins at 0 if no clock was recorded."""
    time = np.arange(len(run)) / rates[run.name] if run.time is None else run.time
    joint, posture = run.joint, run.posture if len(run.posture) else None
    return JointRecording(
        run.name, robot, joint.name, run.session, time, run.signals, posture, joint.gear_ratio, joint.torque_constant
    )


def _kept(runs: Sequence[Run], recordings: Sequence[JointRecording], refused: set[str]) -> tuple[JointRecording, ...]:
    kept = [recording for run, recording in zip(runs, recordings, strict=True) if not {run.label, run.name} & refused]
    return tuple(sorted(kept, key=lambda each: (each.session, each.name, each.joint)))


def _names(runs: Sequence[Run]) -> tuple[tuple[str, str, str], ...]:
    return tuple((run.session, run.name, run.joint.name) for run in runs)


def _require_unique(runs: Sequence[Run]) -> None:
    """Raise a FileDefect if two files have the same run of a joint."""
    seen: set[str] = set()
    for run in runs:
        if run.label in seen:
            raise FileDefect(
                run.file, f"the run {shown(run.label)} twice", "a unique name: let 'path' use more of the file name"
            )
        seen.add(run.label)
