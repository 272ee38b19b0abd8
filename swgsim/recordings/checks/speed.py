"""Checks of the recorded speed: unit, sense, gear ratio, and agreement with the angle."""

from collections.abc import Iterator

import numpy as np

from swgsim.recordings.checks.angle import angle_is_sound, speed_of_angle
from swgsim.recordings.checks.defect import Defect, Severity
from swgsim.recordings.checks.speed_units import SPEED_MISTAKES, mistake
from swgsim.recordings.checks.thresholds import SPEED_REFUSES, SPEED_WARNS
from swgsim.recordings.recording import Recording


def speed_defects(recording: Recording) -> Iterator[Defect]:
    """Defects of the channel n_in."""
    if "n_in" not in recording.channels:
        return
    mean = float(np.mean(recording.channels["n_in"]))
    ratio = mean / recording.point.n_in_rpm
    expected = f"about the set {recording.point.n_in_rpm:g} rpm"
    if ratio < 0:
        yield Defect(
            "speed_backwards", "refuse", recording.name, "n_in", f"a mean of {mean:.4g}", expected,
            "change the sign of the speed",
        )  # fmt: skip
    if ratio == 0:
        yield Defect("no_speed", "refuse", recording.name, "n_in", "a mean of 0", expected, "connect the signal")
    elif abs(abs(ratio) - 1) > SPEED_WARNS:
        kind, reason = mistake(abs(ratio), SPEED_MISTAKES, "speed_against_set_speed")
        severity: Severity = "refuse" if abs(abs(ratio) - 1) > SPEED_REFUSES else "warn"
        remedy = f"{reason}; correct the speed or the set speed"
        yield Defect(kind, severity, recording.name, "n_in", f"a mean of {mean:.4g}", expected, remedy)
    elif angle_is_sound(recording) and abs(speed_of_angle(recording) / ratio - 1) > SPEED_WARNS:
        angle = speed_of_angle(recording) * recording.point.n_in_rpm
        yield Defect(
            "speed_against_angle", "warn", recording.name, "n_in", f"a mean of {mean:.5g} rpm",
            f"the {angle:.5g} rpm of the angle over time", "check the clock and the scale of encoder and speed",
        )  # fmt: skip
