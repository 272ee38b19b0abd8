"""Checks of the wiring: inverted and swapped gauges, from their rise with load and their phases at order 2.

In every gear, s1 and s3 see the two lobes in phase, and so do s2 and s4. s2 follows s1 by a quarter of a turn, which is
the opposite phase at order 2. All gauges rise with load. So an inverted gauge falls with load and has the opposite
phase. A gauge of a swapped pair of neighbours rises with load and has the opposite phase. Order 2 separates neither s1
from s3 nor s2 from s4. It does not show which pair was swapped, a ring of gauges turned by a quarter, or the sense of
rotation.
"""

from collections.abc import Iterator, Sequence
from itertools import groupby

import numpy as np

from swgsim.recordings.checks.defect import Defect
from swgsim.recordings.checks.order_2 import order_2
from swgsim.recordings.checks.thresholds import (
    GAUGE_SMALLEST,
    LOAD_RISE,
    LOAD_SHARE,
    LOAD_SPREAD,
    PHASE_OPPOSITE,
    PHASE_WARNS,
    S0_SCALE,
)
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

# Phase of order 2 against s1, in half turns.
OPPOSITE = {"s1": 0, "s2": 1, "s3": 0, "s4": 1}


def wiring_defects(recordings: Sequence[Recording]) -> Iterator[Defect]:
    """Defects of gauges relative to each other, for each gear and session."""

    def wired(recording: Recording) -> tuple[str, str]:
        return recording.gear, recording.session

    for _, group in groupby(sorted(recordings, key=wired), wired):
        members = list(group)
        rises = rise_with_load(members)
        usual = float(np.median(np.abs(list(rises.values())))) if rises else 0.0
        inverted = {sensor for sensor, rise in rises.items() if rise < -LOAD_SHARE * usual}
        yield from _against_load(members[0].name, rises, inverted)
        for member in members:
            yield from _phases(member, inverted, bool(rises))


def rise_with_load(recordings: Sequence[Recording]) -> dict[str, float]:
    """Rise of the mean of each gauge with the set load [mV/V per N m]; empty if the loads do not differ enough."""
    loads = np.array([recording.point.T_out for recording in recordings])
    if np.ptp(loads) < LOAD_SPREAD:
        return {}
    sensors = [sensor for sensor in SENSORS if all(sensor in recording.channels for recording in recordings)]
    means = np.array([[recording.channels[sensor].mean() for sensor in sensors] for recording in recordings])
    rises = np.polynomial.polynomial.polyfit(loads, means, 1)[1] if sensors else np.zeros(0)
    if not sensors or np.median(np.abs(rises)) * np.ptp(loads) < LOAD_RISE:
        return {}
    return dict(zip(sensors, rises.tolist(), strict=True))


def _against_load(name: str, rises: dict[str, float], inverted: set[str]) -> Iterator[Defect]:
    """Gauges that fall with load, and a torque bridge in another unit than the rest."""
    expected = "signals that rise with load"
    if rises and len(inverted) == len(rises):
        yield Defect(
            "gauges_against_load", "refuse", name, "", "gauges that all fall with load", expected,
            "all gauges are inverted, or the load has the other sign",
        )  # fmt: skip
        return
    for sensor in sorted(inverted):
        yield Defect(
            "gauge_inverted", "refuse", name, sensor, f"{rises[sensor]:.3g} mV/V per N m", expected,
            "change its sign, in the file or by 'inverted: true' in a column map",
        )  # fmt: skip
    others = [abs(rise) for sensor, rise in rises.items() if sensor != "s0"]
    if "s0" in rises and others and not 1 / S0_SCALE < abs(rises["s0"]) / np.median(others) < S0_SCALE:
        yield Defect(
            "gauge_scale", "refuse", name, "s0", f"{rises['s0']:.3g} mV/V per N m",
            f"about twice the {np.median(others):.3g} of the other gauges", "it is in another unit: convert it",
        )  # fmt: skip


def _phases(recording: Recording, inverted: set[str], loads_differ: bool) -> Iterator[Defect]:
    """Defects of the phases at order 2, after correction of gauges that fall with load."""
    lines = {sensor: line for sensor, line in order_2(recording).items() if abs(line) > GAUGE_SMALLEST / 2}
    if len(lines) < 2:
        return
    sensors = list(lines)
    turned = [OPPOSITE[sensor] + (sensor in inverted) for sensor in sensors]
    unit = np.array([line / abs(line) for line in lines.values()]) * np.exp(1j * np.pi * np.array(turned))
    # The axis of the phases, independent of their signs; then the side of most of them.
    axis = np.exp(0.5j * np.angle(np.sum(unit**2)))
    side = np.sign(np.real(unit / axis))
    axis = axis * (np.sign(side.sum()) or 1.0)
    off = np.degrees(np.angle(unit / axis))
    opposite = [sensor for sensor, degrees in zip(sensors, off, strict=True) if abs(degrees) > PHASE_OPPOSITE]
    for sensor, degrees in zip(sensors, off, strict=True):
        if PHASE_WARNS < abs(degrees) <= PHASE_OPPOSITE:
            yield Defect(
                "gauge_position", "warn", recording.name, sensor, f"order 2 off by {degrees:.0f} degrees",
                "the phase of the other gauges", "check its position, and the skew of its channel",
            )  # fmt: skip
    if opposite:
        yield _opposite(recording, sensors, opposite, loads_differ)


def _opposite(recording: Recording, sensors: list[str], opposite: list[str], loads_differ: bool) -> Defect:
    """Possible defects of gauges in opposite phase to the others."""
    rest = [sensor for sensor in sensors if sensor not in opposite]
    sides = " and ".join(opposite), " and ".join(rest)
    neighbours = len(opposite) == len(rest) == 2 and OPPOSITE[opposite[0]] != OPPOSITE[opposite[1]]
    swapped = f"{sides[0]} are swapped, or {sides[1]}"
    if loads_differ:  # Inverted gauges are corrected already.
        kind = "gauges_swapped" if neighbours else "gauges_misplaced"
        remedy = swapped if neighbours else f"{sides[0]} or {sides[1]} are a quarter of a turn off their positions"
    elif len(opposite) == len(rest):
        kind = "gauges_swapped_or_inverted"
        remedy = f"{sides[0]} or {sides[1]} are inverted{', or ' + swapped if neighbours else ''}"
        remedy += "; recordings at two loads separate these cases"
    else:
        kind, remedy = "gauge_inverted", f"{sides[0]} is inverted or bonded a quarter of a turn off its position"
    return Defect(
        kind, "refuse", recording.name, " ".join(opposite), f"{sides[0]} in opposite phase to {sides[1]} at order 2",
        "the lobes at s1, s2, s3 and s4 in turn", remedy,
    )  # fmt: skip
