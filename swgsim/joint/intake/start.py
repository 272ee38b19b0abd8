"""A start-up that goes on after what was cut."""

from collections.abc import Iterator

import numpy as np

from swgsim.joint.intake.run import Run
from swgsim.joint.intake.thresholds import LEAST_MOVED, START_BLOCKS, START_OFF, START_SCATTER, STEADY
from swgsim.joint.recording import JointRecording
from swgsim.recordings.checks.defect import Defect


def start_findings(run: Run, recording: JointRecording) -> Iterator[Defect]:
    """Of a run that is steady later: how long its velocity still changes at first."""
    if np.ptp(run.signals["q"]) < LEAST_MOVED:
        return
    edges = np.linspace(0, len(run), START_BLOCKS + 1).astype(int)
    blocks = np.add.reduceat(run.signals["omega"], edges[:-1]) / np.diff(edges)
    later = blocks[START_BLOCKS // 2 :]
    usual, scatter = float(np.median(later)), float(np.std(later))
    if scatter > STEADY * abs(usual):
        return
    steady = np.abs(blocks - usual) <= max(START_OFF * abs(usual), START_SCATTER * scatter)
    if not steady[0]:
        until = int(edges[np.argmax(steady)])
        yield Defect(
            "start_up", "warn", run.label, "omega",
            f"a velocity that starts at {blocks[0]:.3g} rad/s and is at {usual:.3g} rad/s after {until} samples",
            "a steady velocity, as it is later", f"cut about {until} samples more by start_up of the source",
            run.first_row,
        )  # fmt: skip
