"""An angle that wraps although the source does not say so, or in another unit than it says."""

from collections.abc import Iterator

import numpy as np

from swgsim.joint.intake.run import Run
from swgsim.joint.intake.thresholds import FEWEST_SAMPLES, WRAP_STEP, WRAPPED
from swgsim.recordings.checks.defect import Defect


def wrap_findings(run: Run) -> Iterator[Defect]:
    """What is wrong with how an angle goes on after one revolution."""
    if len(run) < FEWEST_SAMPLES:
        return
    column = next(column for column in run.joint.signals if column.quantity == "q")
    if column.wraps and run.span > WRAPPED:
        degrees = column.unit == "rad" and run.span <= 180 / np.pi * WRAPPED
        yield Defect(
            "angle_in_degrees" if degrees else "angle_beyond_revolution", "refuse", run.label, "q",
            f"numbers that span {run.span:.4g} revolutions of {column.revolution:.4g} {column.unit}",
            "at most one, as the source says that the angle wraps",
            "say unit: deg if the angle is in degrees, or leave wraps out if it goes on",
        )  # fmt: skip
    with np.errstate(invalid="ignore"):  # What is no number is named elsewhere.
        steps = np.abs(np.diff(run.signals["q"])) / (2 * np.pi)
    wraps = np.flatnonzero(np.abs(steps - 1) < WRAP_STEP)
    if not column.wraps and len(wraps) and np.median(steps) < WRAP_STEP:
        yield Defect(
            "angle_wraps", "refuse", run.label, "q", f"{len(wraps)} steps by about one revolution",
            "an angle that goes on", "say wraps: true of q in the source", int(wraps[0]) + 1 + run.first_row,
        )  # fmt: skip
