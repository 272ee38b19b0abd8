"""Checks of the torques: unit, sign, and size against the set load."""

from collections.abc import Iterator

import numpy as np

from swgsim.recordings.checks.defect import Defect, Severity
from swgsim.recordings.checks.thresholds import (
    POOREST_EFFICIENCY,
    RATIOS,
    RUNNING_TORQUE,
    TORQUE_REFUSES,
    TORQUE_WARNS,
    UNIT_TOLERANCE,
)
from swgsim.recordings.recording import Recording

# Found torque over torque in N m, and its unit. They are compared only for torques far from the set load.
UNITS = ((1e3, "mN m"), (1e-3, "kN m"), (100.0, "N cm"), (8.8507, "pound-inches"), (0.73756, "pound-feet"))


def torque_defects(recording: Recording) -> Iterator[Defect]:
    """Defects of the channels T_out and T_in."""
    load = recording.point.T_out
    if "T_out" in recording.channels:
        yield from _output(recording, float(np.mean(recording.channels["T_out"])), load)
    if "T_in" in recording.channels:
        yield from _input(recording, float(np.mean(recording.channels["T_in"])), load)


def _output(recording: Recording, mean: float, load: float) -> Iterator[Defect]:
    """Deviation of the mean from the set load."""
    off = abs(mean - load)
    if off < max(TORQUE_WARNS[0] * load, TORQUE_WARNS[1]):
        return
    severity: Severity = "refuse" if off > max(TORQUE_REFUSES[0] * load, TORQUE_REFUSES[1]) else "warn"
    units = [unit for factor, unit in UNITS if load and abs(abs(mean) / load / factor - 1) < 2.5 * UNIT_TOLERANCE]
    turned = bool(load) and mean < 0 and abs(abs(mean) / load - 1) < TORQUE_REFUSES[0]
    kind = "torque_unit" if units else "torque_sign" if turned else "torque_against_set_load"
    reason = f"it is in {units[0]}" if units else "its sign is wrong" if turned else "zero, scale or set load is wrong"
    yield Defect(
        kind, severity, recording.name, "T_out", f"a mean of {mean:.4g} N m", f"about the set {load:g} N m",
        f"{reason}; correct the torque or the set load",
    )  # fmt: skip


def _input(recording: Recording, mean: float, load: float) -> Iterator[Defect]:
    """Deviation of the mean from the range that drives the load through a gear of any ratio."""
    low, high = load / RATIOS[1], load / RATIOS[0] / POOREST_EFFICIENCY + RUNNING_TORQUE
    if low * (1 - TORQUE_REFUSES[0]) <= mean <= high:
        return
    reason = "it is in mN m, or that of the output" if mean > high else "it is in kN m, or its sign is wrong"
    yield Defect(
        "torque_unit", "refuse", recording.name, "T_in", f"a mean of {mean:.4g} N m",
        f"from {low:.3g} to {high:.3g} N m at a load of {load:g} N m", f"{reason}; correct the torque",
    )  # fmt: skip
