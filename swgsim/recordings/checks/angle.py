"""Checks of the angle of the wave generator: unit, sense, reversals, and lost samples at even time steps."""

from collections.abc import Iterator

import numpy as np
from scipy.ndimage import median_filter

from swgsim.recordings.checks.defect import Defect, Severity
from swgsim.recordings.checks.speed_units import ANGLE_MISTAKES, mistake
from swgsim.recordings.checks.thresholds import (
    ANGLE_JUMP,
    JUMP_MEDIAN,
    JUMP_QUANTILE,
    JUMP_SCATTER,
    SPEED_REFUSES,
    SPEED_WARNS,
    TURNED_BACK,
)
from swgsim.recordings.files.assembly import unwrapped
from swgsim.recordings.recording import Recording
from swgsim.tables.file_defect import FIRST_ROW


def speed_of_angle(recording: Recording) -> float:
    """Mean speed of the angle, relative to the set speed.

    The speed is a trimmed mean over sixteenths of a revolution, without the fastest and slowest quarter. So neither
    steps of an encoder nor wraps of any unit matter.
    """
    phi, time = unwrapped(recording.channels["phi_in"]), recording.time
    lag = min(max(1, round(60 / recording.point.n_in_rpm * recording.rate / 16)), len(time) // 2)
    rates = np.sort((phi[lag:] - phi[:-lag]) / (time[lag:] - time[:-lag]))
    return float(np.mean(rates[len(rates) // 4 : -(len(rates) // 4)])) / recording.point.omega_in


def angle_is_sound(recording: Recording) -> bool:
    """Whether there is an angle in radians that turns about as fast as the set speed."""
    return "phi_in" in recording.channels and abs(speed_of_angle(recording) - 1) < SPEED_REFUSES


def angle_defects(recording: Recording) -> Iterator[Defect]:
    """Defects of the channel phi_in."""
    if "phi_in" not in recording.channels or not np.ptp(recording.channels["phi_in"]):
        return
    ratio = speed_of_angle(recording)
    if abs(ratio - 1) > SPEED_WARNS:
        yield from _wrong_speed(recording, ratio)
    if angle_is_sound(recording):
        yield from _reversals(recording)
        yield from _jumps(recording)


def _wrong_speed(recording: Recording, ratio: float) -> Iterator[Defect]:
    """The angle against the set speed."""
    found = f"an angle that turns {ratio:.4g} times as fast as the set speed"
    expected = f"{recording.point.omega_in:.4g} rad/s, which are {recording.point.n_in_rpm:g} rpm"
    if ratio < 0:
        yield Defect(
            "angle_backwards", "refuse", recording.name, "phi_in", found, f"{expected}, in the positive sense",
            "change the sign of the angle, and number the gauges in the sense of rotation",
        )  # fmt: skip
    if ratio and abs(abs(ratio) - 1) > SPEED_WARNS:
        kind, reason = mistake(abs(ratio), ANGLE_MISTAKES, "angle_against_set_speed")
        severity: Severity = "refuse" if abs(abs(ratio) - 1) > SPEED_REFUSES else "warn"
        remedy = f"{reason}; correct the angle, the time or the set speed"
        yield Defect(kind, severity, recording.name, "phi_in", found, expected, remedy)


def _reversals(recording: Recording) -> Iterator[Defect]:
    """Rotation backwards by more than jitter."""
    phi = unwrapped(recording.channels["phi_in"])
    back = np.maximum.accumulate(phi) - phi
    if back.max() > TURNED_BACK:
        yield Defect(
            "angle_turns_back", "refuse", recording.name, "phi_in", f"an angle that turns back by {back.max():.3g} rad",
            "rotation in one sense", "record at steady speed, and cut starting and stopping",
            int(np.argmax(back > TURNED_BACK)) + FIRST_ROW,
        )  # fmt: skip


def _jumps(recording: Recording) -> Iterator[Defect]:
    """Steps of the angle that miss a sample or more, without compensation by the neighbouring steps."""
    steps = np.diff(unwrapped(recording.channels["phi_in"])) / np.diff(recording.time)
    excess = steps - median_filter(steps, JUMP_MEDIAN, mode="nearest")
    scatter = float(np.quantile(np.abs(excess), JUMP_QUANTILE))
    limit = max(ANGLE_JUMP * speed_of_angle(recording) * recording.point.omega_in, JUMP_SCATTER * scatter)
    kept = np.minimum(np.abs(excess[1:] + excess[:-1])[1:], np.abs(excess[1:] + excess[:-1])[:-1])
    jumps = np.flatnonzero((np.abs(excess[1:-1]) > limit) & (kept > limit)) + 1
    if len(jumps):
        yield Defect(
            "angle_jumps", "refuse", recording.name, "phi_in",
            f"{len(jumps)} steps of the angle that are off by a sample or more while the time steps are even",
            "even steps of the angle", "samples were lost or repeated: record again, or cut before the first",
            int(jumps[0]) + 1 + FIRST_ROW,
        )  # fmt: skip
