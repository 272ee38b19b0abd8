"""A velocity that was not measured, or not of this joint at this time."""

from collections.abc import Iterator

import numpy as np

from swgsim.joint.intake.run import Run
from swgsim.joint.intake.thresholds import (
    APART_REFUSES,
    APART_WARNS,
    FASTEST_JOINT,
    LEAST_MOVED,
    PARTS,
    PARTS_USUAL,
    SET_SHARE,
)
from swgsim.joint.recording import JointRecording
from swgsim.recordings.checks.defect import Defect, Severity


def velocity_findings(run: Run, recording: JointRecording) -> Iterator[Defect]:
    """Constant, set, implausibly fast, or apart from the angle in parts of the run."""
    q, omega, time = run.signals["q"], run.signals["omega"], recording.time
    fast = float(np.median(np.abs(omega)))
    if fast > FASTEST_JOINT:
        yield Defect(
            "implausible_speed", "warn", run.label, "omega", f"{fast:.3g} rad/s in the median",
            f"at most {FASTEST_JOINT:g} at the output of a robot joint",
            "if angle and velocity are in degrees, or are those of the motor, convert them in the source",
        )  # fmt: skip
    if np.ptp(q) < LEAST_MOVED:
        return
    if not np.ptp(omega):
        yield Defect(
            "velocity_constant", "refuse", run.label, "omega", f"{omega[0]:.5g} rad/s throughout",
            f"a velocity that goes with an angle of {np.ptp(q):.3g} rad", "map the measured velocity, or leave it out",
            run.first_row,
        )  # fmt: skip
        return
    turns = np.diff(q) != 0
    held = float(np.mean(np.diff(omega)[turns] == 0)) if turns.any() else 0.0
    if held > SET_SHARE:
        yield Defect(
            "velocity_set", "refuse", run.label, "omega",
            f"a velocity that keeps its value in {100 * held:.3g} % of the steps of the angle", "a measured velocity",
            "this is a set value or one that is read too rarely: map the measured velocity, or leave it out",
        )  # fmt: skip
        return
    yield from _apart(run, q, omega, time)


def _apart(run: Run, q: np.ndarray, omega: np.ndarray, time: np.ndarray) -> Iterator[Defect]:
    """Whether angle and velocity agree in most parts of the run, up to one factor for all."""
    areas = np.concatenate([[0.0], np.cumsum((omega[1:] + omega[:-1]) / 2 * np.diff(time))])
    edges = np.linspace(0, len(q) - 1, PARTS + 1).astype(int)
    by_angle, by_velocity = np.diff(q[edges]), np.diff(areas[edges])
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
