"""Findings on rows and signals: rows that are missing or repeated, and signals that are zero, frozen or clipped."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Bool, Float
from scipy.ndimage import maximum_filter1d

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
    """Jumps of a recorded time; they belong to the file and thus to all of its joints."""
    if run.time is None:
        return
    if run.lost:
        yield Defect(
            "readings_left_out", "warn", run.name, "", f"{run.lost} of {run.lost + len(run)} rows with lost readings",
            "none", "the source leaves them out",
        )  # fmt: skip
    steps = np.diff(run.time)
    usual = float(np.median(steps))
    odd = np.flatnonzero((steps > GAP * usual) | (steps < SHORT_STEP * usual))
    if len(odd):
        severity: Severity = "refuse" if len(odd) > ROWS_REFUSE * len(steps) else "warn"
        yield Defect(
            "time_jumps", severity, run.name, "t", f"{len(odd)} steps such as {steps[odd[0]]:.3g} s",
            f"steps of about {usual:.3g} s", "rows are missing or were written late: cut the run there",
            int(odd[0]) + 1 + run.first_row,
        )  # fmt: skip


def row_findings(run: Run, recording: JointRecording) -> Iterator[Defect]:
    """Rows that repeat all signals, and jumps of the angle beyond its velocity."""
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
            "new numbers in each row", "the recorder stopped: cut the run there, or leave the file out",
            start + 1 + run.first_row,
        )  # fmt: skip
    yield from _jumps(run, recording)


def repeated(run: Run) -> Bool[np.ndarray, " step"]:
    """Steps in which no signal changes. Without a torque or current they look like standstill and are not reported."""
    if not any(name in run.signals and np.ptp(run.signals[name]) for name in PREDICTED):
        return np.zeros(len(run) - 1, bool)
    return np.all([np.diff(values) == 0 for values in run.signals.values()], axis=0)


def _jumps(run: Run, recording: JointRecording) -> Iterator[Defect]:
    """Steps of the angle that differ strongly from velocity times time."""
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
            f"steps of {usual:.2g} rad, as the velocity gives", "rows are missing: cut the run, or leave the file out",
            worst + 1 + run.first_row,
        )  # fmt: skip


def signal_findings(run: Run, recording: JointRecording) -> Iterator[Defect]:
    """Findings of each signal but the velocity, which has its own."""
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
    """Distance from the start to each sample, from finite steps."""
    return np.concatenate([[0.0], np.cumsum(np.minimum(steps, FARTHEST))])


def _frozen(run: Run, name: str, way: Float[np.ndarray, " time"]) -> Iterator[Defect]:
    """The longest distance that a joint moves while a signal keeps its value."""
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
    """Values that pile up at the largest or the smallest value; repeated rows do not count."""
    levels, counts = np.unique(values, return_counts=True)
    starts, lengths = runs(values)
    for end, inward in ((-1, slice(-1 - CLIPPED_LEVELS, -1)), (0, slice(1, 1 + CLIPPED_LEVELS))):
        top, count, near = levels[end], int(counts[end]), counts[inward]
        row = int(lengths[values[starts] == top].max())
        piled = len(near) and count >= max(CLIPPED_COUNT, CLIPPED_PILE * float(np.median(near)))
        if piled and row >= CLIPPED_RUN:
            share = count / len(values)
            severity: Severity = "refuse" if share > CLIPPED_REFUSES else "warn"
            yield Defect(
                "clipped", severity, run.label, name,
                f"{count} samples of exactly {top:.5g}, {row} of them in a row, and none beyond",
                "a signal within the range of its amplifier", "widen the range, and record again",
                int(np.argmax(run.signals[name] == top)) + run.first_row,
            )  # fmt: skip
