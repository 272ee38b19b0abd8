"""Findings on the motion of a run: unusable numbers, wrapped angles, wrong velocities, start-up, standstill, copies."""

import hashlib
from collections.abc import Iterator, Sequence

import numpy as np

from swgsim.joint.intake.run import Run
from swgsim.joint.intake.scale import reads_zero
from swgsim.joint.intake.signals import row_findings, signal_findings
from swgsim.joint.intake.thresholds import (
    APART_REFUSES,
    APART_WARNS,
    FASTEST_JOINT,
    FEWEST_SAMPLES,
    LEAST_MOVED,
    PARTS,
    PARTS_USUAL,
    SCALE_WARNS,
    SET_SHARE,
    START_BLOCKS,
    START_OFF,
    START_SCATTER,
    STEADY,
    WRAP_STEP,
    WRAPPED,
)
from swgsim.joint.recording import PREDICTED, JointRecording
from swgsim.recordings.checks.defect import Defect, Severity
from swgsim.recordings.files.assembly import no_numbers, standing
from swgsim.tables.clock_jump import jump_remedy
from swgsim.tables.limits import LARGEST_NUMBER
from swgsim.tables.measured_table import remedy

FROM_ANGLE = "take it from the angle by omega: {from: q, smoothed_s: 0.05}"


def unusable(run: Run) -> Iterator[Defect]:
    """Numbers that are not finite, a time that does not increase, too few samples."""
    if len(run) < FEWEST_SAMPLES:
        found, expected = f"{len(run)} samples after the start", f"at least {FEWEST_SAMPLES}"
        yield Defect("too_short", "refuse", run.label, "", found, expected, "record longer, or cut less of the start")
    columns = {"t": run.time, **run.signals} if run.time is not None else dict(run.signals)
    columns |= {f"posture {number}": values for number, values in enumerate(run.posture, 1)}
    for name, values in columns.items():
        bad = no_numbers(np.asarray(values))
        if len(bad):
            yield Defect(
                "not_finite", "refuse", run.label, name,
                f"{len(bad)} of {len(run)} samples that are no finite number, the first {np.asarray(values)[bad[0]]}",
                f"finite numbers within {LARGEST_NUMBER:g}", f"{remedy(bad, len(run))}; or leave the signal out",
                int(bad[0]) + run.first_row,
            )  # fmt: skip
    back = standing(run.time) if run.time is not None else np.empty(0, int)
    if run.time is not None and len(back):
        yield Defect(
            "clock_backwards", "refuse", run.label, "t",
            f"{run.time[back[0]]} after {run.time[back[0] - 1]}", "later times",
            jump_remedy(float(run.time[back[0] - 1] - run.time[back[0]])), int(back[0]) + run.first_row,
        )  # fmt: skip


def wrap_findings(run: Run) -> Iterator[Defect]:
    """An angle that wraps although the source does not say so, or that has another unit than the source says."""
    if len(run) < FEWEST_SAMPLES:
        return
    column = next(column for column in run.joint.signals if column.quantity == "q")
    if column.wraps and run.span > WRAPPED:
        degrees = column.unit == "rad" and run.span <= 180 / np.pi * WRAPPED
        yield Defect(
            "angle_in_degrees" if degrees else "angle_beyond_revolution", "refuse", run.label, "q",
            f"numbers that span {run.span:.4g} revolutions of {column.revolution:.4g} {column.unit}",
            "at most one, because the source says that the angle wraps",
            "set unit: deg if the angle is in degrees, or remove wraps if it is continuous",
        )  # fmt: skip
    with np.errstate(invalid="ignore"):  # numbers that are not finite have a finding of their own
        steps = np.abs(np.diff(run.signals["q"])) / (2 * np.pi)
    wraps = np.flatnonzero(np.abs(steps - 1) < WRAP_STEP)
    if not column.wraps and len(wraps) and np.median(steps) < WRAP_STEP:
        yield Defect(
            "angle_wraps", "refuse", run.label, "q", f"{len(wraps)} steps by about one revolution",
            "a continuous angle", "set wraps: true for q in the source", int(wraps[0]) + 1 + run.first_row,
        )  # fmt: skip


def moving_findings(run: Run, recording: JointRecording) -> Iterator[Defect]:
    """All findings of one joint in motion with a known rate."""
    yield from _motor_turn(run)
    yield from _short(run)
    for detect in (_velocity, row_findings, signal_findings):
        yield from detect(run, recording)
    yield from _start(run)


def at_rest_findings(run: Run) -> Iterator[Defect]:
    """Findings of one joint at standstill: it must not move, and its signals must have noise."""
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
                "the noise of a sensor", "leave the file out: its noise would be 0",
            )  # fmt: skip


def duplicate_findings(runs: Sequence[Run]) -> Iterator[Defect]:
    """Equal numbers under two names: one could be fitted and the other be held out."""
    first: dict[str, str] = {}
    for run in runs:
        digest = hashlib.sha256()
        for name in sorted(run.signals):
            digest.update(name.encode() + run.signals[name].tobytes())
        label = first.setdefault(digest.hexdigest(), run.label)
        if label != run.label:
            yield Defect(
                "same_twice", "refuse", run.label, "", f"the same numbers as in {label}", "different runs",
                "leave one of the files out",
            )  # fmt: skip


def _motor_turn(run: Run) -> Iterator[Defect]:
    """An angle of the motor that is known within one of its revolutions only."""
    column = next(column for column in run.joint.signals if column.quantity == "q")
    if column.wraps and column.revolution * abs(column.gain) < 2 * np.pi * (1 - WRAP_STEP):
        yield Defect(
            "angle_of_motor_turn", "warn", run.label, "q", "an angle within one revolution of the motor",
            "an angle that is known at the output",
            "its zero is another one in each run: gravity and orders of the output are wrong; use a counter of "
            "revolutions, or runs that all begin in one revolution of the motor",
        )  # fmt: skip


def _short(run: Run) -> Iterator[Defect]:
    """Less than one revolution of the motor, if the gear ratio is known."""
    if run.joint.gear_ratio is None:
        return
    turns = float(np.ptp(run.signals["q"])) * run.joint.gear_ratio / (2 * np.pi)
    if turns < 1:
        yield Defect(
            "short_way", "warn", run.label, "q", f"{turns:.2f} revolutions of the motor", "at least 1",
            "record longer or faster: the ripple of the gear cannot be separated from the zero of a sensor",
        )  # fmt: skip


def _velocity(run: Run, recording: JointRecording) -> Iterator[Defect]:
    """A velocity that is constant, set, implausibly fast, or different from the angle in parts of the run."""
    q, omega, time = run.signals["q"], run.signals["omega"], recording.time
    fast = float(np.median(np.abs(omega)))
    if fast > FASTEST_JOINT:
        yield Defect(
            "implausible_speed", "warn", run.label, "omega", f"{fast:.3g} rad/s in the median",
            f"at most {FASTEST_JOINT:g} at the output of a robot joint",
            "if angle and velocity are in degrees, set their unit; if they are those of the motor, set at: motor",
        )  # fmt: skip
    if np.ptp(q) < LEAST_MOVED:
        return
    if not np.ptp(omega):
        yield Defect(
            "velocity_constant", "refuse", run.label, "omega", f"{omega[0]:.5g} rad/s throughout",
            f"a velocity that fits an angle of {np.ptp(q):.3g} rad",
            f"map a measured velocity, or {FROM_ANGLE}", run.first_row,
        )  # fmt: skip
        return
    turns = np.diff(q) != 0
    held = float(np.mean(np.diff(omega)[turns] == 0)) if turns.any() else 0.0
    if held > SET_SHARE:
        yield Defect(
            "velocity_set", "refuse", run.label, "omega",
            f"a velocity that keeps its value in {100 * held:.3g} % of the steps of the angle", "a measured velocity",
            f"this is a set value, or it is sampled too rarely: map a measured velocity, or {FROM_ANGLE}",
        )  # fmt: skip
        return
    yield from _dead_band(run, q, omega)
    yield from _apart(run, q, omega, time)


def _dead_band(run: Run, q: np.ndarray, omega: np.ndarray) -> Iterator[Defect]:
    """A velocity that reads 0 while the joint turns slowly."""
    zero, steps = reads_zero(omega), np.abs(np.diff(q))
    share = float(steps[zero].sum() / steps.sum())
    if share > SCALE_WARNS:
        slowest = float(np.abs(omega[omega != 0]).min())
        yield Defect(
            "velocity_dead_band", "warn", run.label, "omega",
            f"a velocity of exactly 0 on {100 * share:.2g} % of the way, and never between 0 and {slowest:.2g} rad/s",
            "a velocity that is measured also when it is small", FROM_ANGLE,
        )  # fmt: skip


def _apart(run: Run, q: np.ndarray, omega: np.ndarray, time: np.ndarray) -> Iterator[Defect]:
    """Whether angle and velocity agree in most parts of the run, up to one common factor."""
    shown = ~reads_zero(omega)
    steps = np.stack([shown * np.diff(q), (omega[1:] + omega[:-1]) / 2 * np.diff(time)])
    edges = np.linspace(0, len(q) - 1, PARTS + 1).astype(int)
    by_angle, by_velocity = np.add.reduceat(steps, edges[:-1], axis=1)
    scale = float(by_angle @ by_velocity / (by_velocity @ by_velocity)) if by_velocity.any() else 0.0
    beyond = np.abs(by_angle - scale * by_velocity)
    usual = beyond <= np.quantile(beyond, PARTS_USUAL)
    apart = float(np.linalg.norm(beyond[usual]) / np.linalg.norm(by_angle))
    if apart > APART_WARNS:
        severity: Severity = "refuse" if apart > APART_REFUSES else "warn"
        yield Defect(
            "velocity_against_angle", severity, run.label, "omega",
            f"parts of the run in which angle and velocity differ by {100 * apart:.2g} % rms",
            f"at most {100 * APART_WARNS:g} %", "check that angle and velocity are of the same joint and time",
        )  # fmt: skip


def _start(run: Run) -> Iterator[Defect]:
    """A start-up that was not cut, in a run with a steady velocity later."""
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
