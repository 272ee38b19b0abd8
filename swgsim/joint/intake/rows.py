"""Rows that are missing, or there several times: by the clock, by the angle, and by all signals at once."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Bool
from scipy.ndimage import maximum_filter1d

from swgsim.joint.intake.run import Run
from swgsim.joint.intake.thresholds import (
    GAP,
    HELD_ROWS,
    JUMP_AROUND,
    JUMP_QUANTILE,
    JUMP_SCATTER,
    JUMP_STEPS,
    LEAST_MOVED,
    ROWS_REFUSE,
    SHORT_STEP,
)
from swgsim.joint.recording import PREDICTED, JointRecording
from swgsim.recordings.checks.channel import runs
from swgsim.recordings.checks.defect import Defect, Severity


def gap_findings(run: Run) -> Iterator[Defect]:
    """Steps of a recorded time that jump; they are those of the file, whichever joint is looked at."""
    if run.time is None:
        return
    steps = np.diff(run.time)
    usual = float(np.median(steps))
    odd = np.flatnonzero((steps > GAP * usual) | (steps < SHORT_STEP * usual))
    if len(odd):
        severity: Severity = "refuse" if len(odd) > ROWS_REFUSE * len(steps) else "warn"
        yield Defect(
            "time_jumps", severity, run.name, "t", f"{len(odd)} steps such as {steps[odd[0]]:.3g} s",
            f"steps of about {usual:.3g} s", "rows are missing or were written late: cut there if they are missing",
            int(odd[0]) + 1 + run.first_row,
        )  # fmt: skip


def row_findings(run: Run, recording: JointRecording) -> Iterator[Defect]:
    """Rows in which all signals stand still, and jumps of the angle beyond its velocity."""
    again = repeated(run)
    starts, lengths = runs(again.astype(float))
    held = [(int(start), int(length)) for start, length in zip(starts, lengths, strict=True) if again[start]]
    long = [(start, length) for start, length in held if length >= HELD_ROWS]
    share = float(again.mean())
    if long or share > ROWS_REFUSE:
        start, length = max(long or held, key=lambda each: each[1])
        severity: Severity = "refuse" if share > ROWS_REFUSE else "warn"
        yield Defect(
            "repeated_rows", severity, run.label, "",
            f"{int(again.sum())} rows that repeat the one before, {length} of them in a row",
            "new numbers in each row", "the recorder stood still: cut there, or leave the file out",
            start + 1 + run.first_row,
        )  # fmt: skip
    yield from _jumps(run, recording)


def repeated(run: Run) -> Bool[np.ndarray, " step"]:
    """Steps in which no signal changes; none without a torque or current, whose noise tells standstill from it."""
    if not any(name in run.signals and np.ptp(run.signals[name]) for name in PREDICTED):
        return np.zeros(len(run) - 1, bool)
    return np.all([np.diff(values) == 0 for values in run.signals.values()], axis=0)


def _jumps(run: Run, recording: JointRecording) -> Iterator[Defect]:
    """Steps of the angle that are far from velocity times time."""
    q, omega = run.signals["q"], run.signals["omega"]
    if np.ptp(q) < LEAST_MOVED or not omega.any():
        return
    areas = (omega[1:] + omega[:-1]) / 2 * np.diff(recording.time)
    beyond = np.abs(np.diff(q) - areas)
    around = maximum_filter1d(np.abs(areas), 2 * JUMP_AROUND + 1, mode="nearest")
    scatter = float(np.quantile(beyond, JUMP_QUANTILE))
    jumps = np.flatnonzero((beyond > JUMP_STEPS * around) & (beyond > JUMP_SCATTER * scatter))
    if len(jumps):
        usual = float(np.mean(np.abs(areas)))
        lost = float(np.sum(beyond[jumps])) / usual
        worst = int(jumps[np.argmax(beyond[jumps])])
        severity: Severity = "refuse" if lost > ROWS_REFUSE * len(q) else "warn"
        yield Defect(
            "angle_jumps", severity, run.label, "q",
            f"{len(jumps)} steps that are {lost:.0f} usual steps too long, one of {beyond[worst]:.2g} rad",
            f"steps as the velocity says, {usual:.2g} rad", "rows are missing: cut there, or leave the file out",
            worst + 1 + run.first_row,
        )  # fmt: skip
