"""Signals that are zero, frozen or clipped."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from swgsim.joint.intake.rows import repeated
from swgsim.joint.intake.run import Run
from swgsim.joint.intake.thresholds import (
    CLIPPED_COUNT,
    CLIPPED_LEVELS,
    CLIPPED_PILE,
    CLIPPED_REFUSES,
    CLIPPED_RUN,
    FARTHEST,
    FROZEN_REFUSES,
    FROZEN_WARNS,
    LEAST_MOVED,
)
from swgsim.joint.recording import PREDICTED, JointRecording
from swgsim.recordings.checks.channel import runs
from swgsim.recordings.checks.defect import Defect, Severity


def signal_findings(run: Run, recording: JointRecording) -> Iterator[Defect]:
    """Of each signal but the velocity, which has findings of its own."""
    fresh = ~repeated(run)
    with np.errstate(over="ignore"):  # a velocity from steps of time next to 0
        by_velocity = _summed(fresh * np.abs(run.signals["omega"][1:]) * np.diff(recording.time))
    by_angle = _summed(np.abs(np.diff(run.signals["q"])))
    for name, values in run.signals.items():
        if name in ("T_rigid", *PREDICTED) and not values.any():
            severity: Severity = "refuse" if name in PREDICTED else "warn"
            yield Defect(
                "all_zero", severity, run.label, name, "0 throughout", "a signal",
                "check the connection, or leave the signal out of the source",
            )  # fmt: skip
        elif name in ("q", *PREDICTED):
            yield from _frozen(run, name, by_velocity if name == "q" else by_angle)
            if name in PREDICTED:
                yield from _clipped(run, name, values[np.concatenate([[True], fresh])])


def _summed(steps: Float[np.ndarray, " step"]) -> Float[np.ndarray, " time"]:
    """The way from the start to each sample, of finite steps; a row that only repeats the one before adds nothing."""
    return np.concatenate([[0.0], np.cumsum(np.minimum(steps, FARTHEST))])


def _frozen(run: Run, name: str, way: Float[np.ndarray, " time"]) -> Iterator[Defect]:
    """The longest way that a joint goes while a signal keeps its value."""
    values = run.signals[name]
    starts, lengths = runs(values)
    ways = way[starts + lengths - 1] - way[starts]
    longest = int(np.argmax(ways))
    share = float(ways[longest] / way[-1]) if way[-1] >= LEAST_MOVED else 0.0
    if share > FROZEN_WARNS:
        severity: Severity = "refuse" if share > FROZEN_REFUSES else "warn"
        yield Defect(
            "frozen", severity, run.label, name,
            f"{lengths[longest]} times {values[starts[longest]]:.5g} in a row, for {100 * share:.2g} % of the way",
            "a signal that changes", "check the connection, and record again", int(starts[longest]) + run.first_row,
        )  # fmt: skip


def _clipped(run: Run, name: str, values: Float[np.ndarray, " fresh"]) -> Iterator[Defect]:
    """Values that pile up at the largest or the smallest one; rows that only repeat others are not counted."""
    levels, counts = np.unique(values, return_counts=True)
    starts, lengths = runs(values)
    for end, inward in ((-1, slice(-1 - CLIPPED_LEVELS, -1)), (0, slice(1, 1 + CLIPPED_LEVELS))):
        top, count, beside = levels[end], int(counts[end]), counts[inward]
        row = int(lengths[values[starts] == top].max())
        piled = len(beside) and count >= max(CLIPPED_COUNT, CLIPPED_PILE * float(np.median(beside)))
        if piled and row >= CLIPPED_RUN:
            share = count / len(values)
            severity: Severity = "refuse" if share > CLIPPED_REFUSES else "warn"
            yield Defect(
                "clipped", severity, run.label, name,
                f"{count} samples of exactly {top:.5g}, {row} of them in a row, and none beyond",
                "a signal within the range of its amplifier", "widen the range, and record again",
                int(np.argmax(run.signals[name] == top)) + run.first_row,
            )  # fmt: skip
