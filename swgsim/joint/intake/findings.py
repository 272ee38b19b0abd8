"""All that the numbers of joints show of how they were recorded: findings refuse or warn, and nothing is mended."""

import hashlib
from collections.abc import Iterator, Sequence

import numpy as np

from swgsim.joint.intake.rows import row_findings
from swgsim.joint.intake.run import Run
from swgsim.joint.intake.signals import signal_findings
from swgsim.joint.intake.start import start_findings
from swgsim.joint.intake.thresholds import LEAST_MOVED
from swgsim.joint.intake.velocity import velocity_findings
from swgsim.joint.recording import PREDICTED, JointRecording
from swgsim.recordings.checks.defect import Defect


def moving_findings(run: Run, recording: JointRecording) -> Iterator[Defect]:
    """Of one joint in motion whose rate is known."""
    yield from _short(run)
    for detect in (velocity_findings, row_findings, signal_findings, start_findings):
        yield from detect(run, recording)


def at_rest_findings(run: Run) -> Iterator[Defect]:
    """Of one joint at standstill: it must not move, and its signals must show their noise."""
    moved = float(np.ptp(run.signals["q"]))
    if moved > LEAST_MOVED:
        yield Defect(
            "moves_at_rest", "refuse", run.label, "q", f"an angle that moves by {moved:.3g} rad",
            f"a joint at standstill, within {LEAST_MOVED} rad", "list the file under 'files', or leave it out",
        )  # fmt: skip
    for name in PREDICTED:
        if name in run.signals and not np.ptp(run.signals[name]):
            yield Defect(
                "no_noise", "refuse", run.label, name, f"{run.signals[name][0]:.5g} throughout",
                "the noise of a sensor", "leave the file out: its noise floor would be 0",
            )  # fmt: skip


def copy_findings(runs: Sequence[Run]) -> Iterator[Defect]:
    """The same numbers under two names: on either side of a split they would be known beforehand."""
    first: dict[str, str] = {}
    for run in runs:
        digest = hashlib.sha256()
        for name in sorted(run.signals):
            digest.update(name.encode() + run.signals[name].tobytes())
        label = first.setdefault(digest.hexdigest(), run.label)
        if label != run.label:
            yield Defect(
                "same_twice", "refuse", run.label, "", f"the very numbers of {label}", "a run of its own",
                "leave one of the files out",
            )  # fmt: skip


def unsaid_findings(files: Sequence[str]) -> Iterator[Defect]:
    """Files that the source says nothing of."""
    if files:
        more = f" and {len(files) - 1} more" if len(files) > 1 else ""
        yield Defect(
            "not_in_source", "warn", files[0], "", f"{files[0]}{more}, which no pattern of the source matches",
            "a pattern of 'files', 'rest' or 'leave_out'", "name them in the source; they were not read",
        )  # fmt: skip


def _short(run: Run) -> Iterator[Defect]:
    """Fewer than one revolution of the motor, if its gear ratio is known."""
    if run.joint.gear_ratio is None:
        return
    turns = float(np.ptp(run.signals["q"])) * run.joint.gear_ratio / (2 * np.pi)
    if turns < 1:
        yield Defect(
            "short_way", "warn", run.label, "q", f"{turns:.2f} revolutions of the motor", "at least 1",
            "record longer or faster: the ripple of the gear cannot be told apart from the zero of a sensor",
        )  # fmt: skip
