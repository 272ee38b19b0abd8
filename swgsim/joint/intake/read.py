"""The one way in for recordings of joints: files through a source, with what their numbers say of the recording."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np

from swgsim.joint.intake.clock import measured_rates, usual_rates
from swgsim.joint.intake.findings import at_rest_findings, copy_findings, moving_findings, unsaid_findings
from swgsim.joint.intake.places import places
from swgsim.joint.intake.rows import gap_findings
from swgsim.joint.intake.run import Run, read_runs
from swgsim.joint.intake.scale import clock_findings, no_rate, rate_findings
from swgsim.joint.intake.source import JointSource
from swgsim.joint.intake.source_file import read_source
from swgsim.joint.intake.unusable import unusable
from swgsim.joint.intake.wrapping import wrap_findings
from swgsim.joint.recording import JointRecording
from swgsim.recordings.checks.defect import Defect
from swgsim.recordings.files.file_defect import FileDefect, shown


@dataclass(frozen=True)
class JointFiles:
    """What was read of a folder.

    Attributes
    ----------
    recordings, at_rest : tuple of JointRecording
        Those that may be used, in motion and at standstill, in the order of session, name and joint.
    defects : tuple of Defect
        All that was found; a recording with one that refuses is in neither of the others.
    standing : tuple of JointRecording
        Joints that stood while the one moved that the path of their file names, for the noise of their signals.
    """

    recordings: tuple[JointRecording, ...]
    at_rest: tuple[JointRecording, ...]
    defects: tuple[Defect, ...]
    standing: tuple[JointRecording, ...] = ()


def read_joints(folder: Path, source: JointSource | Path) -> JointFiles:
    """Recordings of the joints of a robot.

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
    in_motion = [run for name in found.moving for run in read_runs(folder, name, source, start=True)]
    moving = [run for run in in_motion if not run.stands]
    # Nobody asked for these: one that moved after all, or has no numbers, is no finding.
    standing = [run for run in in_motion if run.stands and not any(chain(unusable(run), at_rest_findings(run)))]
    resting = [run for name in found.resting for run in read_runs(folder, name, source, start=False)]
    _require_names_of_their_own([*moving, *resting])
    defects = [*unsaid_findings(found.unsaid)]
    defects += [defect for run in [*moving, *resting] for defect in chain(unusable(run), wrap_findings(run))]
    refused = {defect.recording for defect in defects}
    moving, resting = ([run for run in runs if run.label not in refused] for runs in (moving, resting))
    measured = measured_rates(moving) if source.rate_from_motion else {}
    usual = usual_rates([*moving, *resting], measured, source)
    if source.rate_from_motion and not usual:
        defects += [no_rate(run) for run in [*moving, *resting]]
        return JointFiles((), (), tuple(defects))
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
    defects += copy_findings([*moving, *resting])
    refused |= {defect.recording for defect in defects if defect.severity == "refuse"}
    return JointFiles(
        _kept(moving, recordings, refused),
        _kept(resting, at_rest, refused),
        tuple(defects),
        tuple(_recording(run, usual | measured, source.robot) for run in standing),
    )


def _recording(run: Run, rates: Mapping[str, float], robot: str) -> JointRecording:
    """A run with its time, which begins at 0 where no clock was recorded."""
    time = np.arange(len(run)) / rates[run.name] if run.time is None else run.time
    joint = run.joint
    return JointRecording(
        run.name,
        robot,
        joint.name,
        run.session,
        time,
        run.signals,
        run.posture if len(run.posture) else None,
        joint.gear_ratio,
        joint.torque_constant,
    )


def _kept(runs: Sequence[Run], recordings: Sequence[JointRecording], refused: set[str]) -> tuple[JointRecording, ...]:
    kept = [recording for run, recording in zip(runs, recordings, strict=True) if not {run.label, run.name} & refused]
    return tuple(sorted(kept, key=lambda each: (each.session, each.name, each.joint)))


def _require_names_of_their_own(runs: Sequence[Run]) -> None:
    """Raise a FileDefect if two files have the same run of a joint."""
    seen: set[str] = set()
    for run in runs:
        if run.label in seen:
            raise FileDefect(run.file, f"the run {shown(run.label)} twice", "a name of its own: let 'path' say more")
        seen.add(run.label)
