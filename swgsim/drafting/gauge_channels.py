"""Channels of a gear test bench with strain gauges: angle, speed, torques and bridges."""

from collections.abc import Iterator, Mapping, Sequence
from math import pi
from typing import Any

import numpy as np
from jaxtyping import Float

from swgsim.drafting.bridges import bridges
from swgsim.drafting.draft_line import DraftLine, joined, place
from swgsim.drafting.file_column import FileColumn
from swgsim.drafting.motion import ANGLE_UNITS, slope_of, unwrapped
from swgsim.drafting.motion_units import motion_units
from swgsim.drafting.named_column import NamedColumn
from swgsim.drafting.order_2 import clearest, has_order_2
from swgsim.drafting.vocabulary import INPUT, OUTPUT
from swgsim.tables.units import FACTORS, OUTPUTS


def gauge_channels(
    named: Sequence[NamedColumn],
    time: Float[np.ndarray, " time"] | None,
    known: Mapping[str, Any],
) -> list[DraftLine]:
    """What the columns of a test bench are taken for; those that are not understood come last.

    Parameters
    ----------
    named : sequence of NamedColumn
        The columns that are no time.
    time : array (time,), optional
        [s]; None if no time was found.
    known : mapping
        Facts of the user, such as ``n_in_rpm`` or ``full_scale``.
    """
    usable = [each for each in named if not each.column.is_text and not each.meaning.is_set_point]
    kinds = {
        kind: [each for each in usable if each.meaning.quantity == kind]
        for kind in ("angle", "speed", "torque", "gauge")
    }
    drafted = list(_turning(kinds["angle"], kinds["speed"], kinds["gauge"], time, known))
    angle = _angle(drafted, time, known)
    gauges = kinds["gauge"]
    if not gauges and angle is not None:
        unnamed = [each for each in usable if each.meaning.quantity in ("", "voltage")]
        gauges = [each for each in unnamed if has_order_2(each.column, angle)]
    drafted += _torques(kinds["torque"])
    drafted += bridges(gauges, angle, known)
    used = {id(each.column) for each in drafted}
    return drafted + [_left(each) for each in named if id(each.column) not in used]


def _left(each: NamedColumn) -> DraftLine:
    meaning = each.meaning
    why = "text" if each.column.is_text else "a set point" if meaning.is_set_point else meaning.quantity
    return DraftLine(each.column, "", why=why and f"{why}, not needed")


def _turning(
    angles: Sequence[NamedColumn], speeds: Sequence[NamedColumn], gauges: Sequence[NamedColumn],
    time: Float[np.ndarray, " time"] | None, known: Mapping[str, Any],
) -> Iterator[DraftLine]:  # fmt: skip
    """Angle and speed of the wave generator: the fastest where the names do not say the side."""
    angle = _of_input(angles, lambda column: float(np.ptp(unwrapped(column.values))))
    speed = _of_input(speeds, lambda column: float(np.nanmean(np.abs(column.values))))
    likely: list[str] = []
    if angle and not angle.column.unit:
        likely = _units_by_speed(angle.column, time, known) or _units_by_lobes(angle.column, gauges)
    if angle:
        units = motion_units(angle.column, speed.column if speed else None, time, likely)
        ask = "" if likely else units.of_angle
        why = joined(angle.meaning.why, "two cycles per turn at the gauges" if likely else "", units.why)
        yield DraftLine(angle.column, "phi_in", place(angle.column) | units.angle, why, ask)
        if speed:
            ask = units.of_speed or (
                f"the slope of {angle.column.column} is {1 / units.ratio:.3g} of it" * (units.ratio != 1)
            )
            why = joined(speed.meaning.why, units.why)
            yield DraftLine(speed.column, "n_in", place(speed.column) | units.speed, why, ask)
    elif speed:
        said = speed.column.unit in FACTORS["rpm"]
        unit, ask = (speed.column.unit, "") if said else ("rpm", "no unit is said: rpm is assumed")
        yield DraftLine(speed.column, "n_in", place(speed.column) | {"unit": unit}, speed.meaning.why, ask)


def _of_input(named: Sequence[NamedColumn], size: Any) -> NamedColumn | None:
    """The channel of the input side: by its name, else the largest one that is not of the output."""
    of_input = [each for each in named if each.meaning.says(INPUT)]
    rest = [each for each in named if not each.meaning.says(OUTPUT)] or list(named) * (len(named) == 1)
    return max(of_input or rest, key=lambda each: size(each.column), default=None)


def _units_by_speed(angle: FileColumn, time: Float[np.ndarray, " time"] | None, known: Mapping[str, Any]) -> list[str]:
    """Unit of an angle that turns at the set speed; none if the speed is not known."""
    if "n_in_rpm" not in known or time is None:
        return []
    turned = slope_of(angle.values, np.ones(len(time)), time).factor
    wanted = float(known["n_in_rpm"]) * pi / 30
    return [unit for unit in ANGLE_UNITS if abs(turned * FACTORS["rad"][unit] / wanted - 1) < 0.1]


def _units_by_lobes(angle: FileColumn, gauges: Sequence[NamedColumn]) -> list[str]:
    """Unit of an angle by which the gauges show two cycles per revolution."""
    if not gauges:
        return []
    angles = [unwrapped(angle.values) * FACTORS["rad"][unit] for unit in ANGLE_UNITS]
    columns = [each.column for each in gauges]
    best = clearest(columns, angles)
    return [ANGLE_UNITS[best]] if any(has_order_2(column, angles[best]) for column in columns) else []


def _angle(
    drafted: Sequence[DraftLine], time: Float[np.ndarray, " time"] | None, known: Mapping[str, Any]
) -> Float[np.ndarray, " time"] | None:
    """Angle of the wave generator [rad]; by the set speed if it was not recorded."""
    for each in drafted:
        if each.quantity == "phi_in" and each.entry["unit"] in FACTORS["rad"]:
            return unwrapped(each.column.values) * FACTORS["rad"][each.entry["unit"]]
        if each.quantity == "phi_in":
            return unwrapped(each.column.values) * 2 * pi / each.entry["per_revolution"]
    if time is None:
        return None
    for each in drafted:
        if each.quantity == "n_in" and each.entry["unit"] in FACTORS["rad/s"]:
            mean = float(np.nanmean(each.column.values)) * FACTORS["rad/s"][each.entry["unit"]]
            return mean * (time - time[0])
    return float(known["n_in_rpm"]) * pi / 30 * (time - time[0]) if "n_in_rpm" in known else None


def _torques(torques: Sequence[NamedColumn]) -> Iterator[DraftLine]:
    """Torques of the input and the output: by the names, else the larger one is that of the output."""
    ranked = sorted(torques, key=lambda each: -_newton_metres(each.column))
    of_output = next((each for each in ranked if each.meaning.says(OUTPUT)), None)
    of_input = next((each for each in ranked if each.meaning.says(INPUT) and each is not of_output), None)
    rest = [each for each in ranked if each not in (of_output, of_input)]
    ask = "" if of_output else "torque at the output? it has the largest torque"
    if not of_output and rest:
        of_output = rest.pop(0)
    ask_in = "" if of_input else "torque at the input?"
    if not of_input and rest:
        of_input = rest.pop(0)
    for channel, each, question in (("T_out", of_output, ask), ("T_in", of_input, ask_in)):
        if each:
            column = each.column
            unit = column.unit if column.unit in (*FACTORS["N m"], *OUTPUTS) else "N m"
            said = "" if column.unit else "no unit is said: N m is assumed"
            yield DraftLine(column, channel, place(column) | {"unit": unit}, each.meaning.why, question or said)


def _newton_metres(column: FileColumn) -> float:
    """Mean torque, by which two are compared."""
    return abs(float(np.nanmean(column.values))) * FACTORS["N m"].get(column.unit, 1.0)
