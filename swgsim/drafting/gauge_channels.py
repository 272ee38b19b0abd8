"""Channels of a gear test bench with strain gauges: angle, speed, torques and bridges."""

from collections.abc import Iterator, Mapping, Sequence
from math import pi
from typing import Any

import numpy as np
from jaxtyping import Float

from swgsim.drafting.bridges import Pair, bridges
from swgsim.drafting.motion import ANGLE_UNITS, slope_of, unwrapped
from swgsim.drafting.motion_units import motion_units
from swgsim.drafting.order_2 import clearest, has_order_2
from swgsim.drafting.seen_column import SeenColumn
from swgsim.drafting.taken import Taken, joined, place
from swgsim.drafting.vocabulary import INPUT, OUTPUT
from swgsim.drafting.words import Meaning
from swgsim.tables.units import FACTORS, OUTPUTS


def gauge_channels(
    columns: Sequence[SeenColumn],
    meanings: Sequence[Meaning],
    time: Float[np.ndarray, " time"] | None,
    known: Mapping[str, Any],
) -> list[Taken]:
    """What the columns of a test bench are taken for; those that are not understood come last.

    Parameters
    ----------
    columns : sequence of SeenColumn
        Those that are no time.
    meanings : sequence of Meaning
    time : array (time,), optional
        [s]; None if no time was found.
    known : mapping
        Facts of the user, such as ``n_in_rpm`` or ``full_scale``.
    """
    pairs = [pair for pair in zip(columns, meanings, strict=True) if not pair[0].is_text and not pair[1].is_set_point]
    kinds = {
        kind: [pair for pair in pairs if pair[1].quantity == kind] for kind in ("angle", "speed", "torque", "gauge")
    }
    taken = list(_turning(kinds["angle"], kinds["speed"], kinds["gauge"], time, known))
    angle = _angle(taken, time, known)
    gauges = kinds["gauge"]
    if not gauges and angle is not None:
        gauges = [pair for pair in pairs if pair[1].quantity in ("", "voltage") and has_order_2(pair[0], angle)]
    taken += _torques(kinds["torque"])
    taken += bridges(gauges, angle, known)
    used = {id(each.column) for each in taken}
    return taken + [_left(*pair) for pair in zip(columns, meanings, strict=True) if id(pair[0]) not in used]


def _left(column: SeenColumn, meaning: Meaning) -> Taken:
    why = "text" if column.is_text else "a set point" if meaning.is_set_point else meaning.quantity
    return Taken(column, "", why=why and f"{why}, not needed")


def _turning(
    angles: Sequence[Pair], speeds: Sequence[Pair], gauges: Sequence[Pair], time: Float[np.ndarray, " time"] | None,
    known: Mapping[str, Any],
) -> Iterator[Taken]:  # fmt: skip
    """Angle and speed of the wave generator: the fastest where the names do not say the side."""
    angle = _of_input(angles, lambda column: float(np.ptp(unwrapped(column.values))))
    speed = _of_input(speeds, lambda column: float(np.nanmean(np.abs(column.values))))
    likely: list[str] = []
    if angle and not angle[0].unit:
        likely = _units_by_speed(angle[0], time, known) or _units_by_lobes(angle[0], gauges)
    if angle:
        units = motion_units(angle[0], speed[0] if speed else None, time, likely)
        ask = "" if likely else units.of_angle
        why = joined(angle[1].why, "two cycles per turn at the gauges" if likely else "", units.why)
        yield Taken(angle[0], "phi_in", place(angle[0]) | units.angle, why, ask)
        if speed:
            ask = units.of_speed or (
                f"the slope of {angle[0].column} is {1 / units.ratio:.3g} of it" * (units.ratio != 1)
            )
            yield Taken(speed[0], "n_in", place(speed[0]) | units.speed, joined(speed[1].why, units.why), ask)
    elif speed:
        unit, ask = (
            (speed[0].unit, "") if speed[0].unit in FACTORS["rpm"] else ("rpm", "no unit is said: rpm is assumed")
        )
        yield Taken(speed[0], "n_in", place(speed[0]) | {"unit": unit}, speed[1].why, ask)


def _of_input(pairs: Sequence[Pair], size: Any) -> Pair | None:
    """The channel of the input side: by its name, else the largest one that is not of the output."""
    of_input = [pair for pair in pairs if pair[1].says(INPUT)]
    rest = [pair for pair in pairs if not pair[1].says(OUTPUT)] or list(pairs) * (len(pairs) == 1)
    return max(of_input or rest, key=lambda pair: size(pair[0]), default=None)


def _units_by_speed(angle: SeenColumn, time: Float[np.ndarray, " time"] | None, known: Mapping[str, Any]) -> list[str]:
    """Unit of an angle that turns at the set speed; none if the speed is not known."""
    if "n_in_rpm" not in known or time is None:
        return []
    turned = slope_of(angle.values, np.ones(len(time)), time).factor
    wanted = float(known["n_in_rpm"]) * pi / 30
    return [unit for unit in ANGLE_UNITS if abs(turned * FACTORS["rad"][unit] / wanted - 1) < 0.1]


def _units_by_lobes(angle: SeenColumn, gauges: Sequence[Pair]) -> list[str]:
    """Unit of an angle by which the gauges show two cycles per revolution."""
    if not gauges:
        return []
    angles = [unwrapped(angle.values) * FACTORS["rad"][unit] for unit in ANGLE_UNITS]
    columns = [column for column, _ in gauges]
    best = clearest(columns, angles)
    return [ANGLE_UNITS[best]] if any(has_order_2(column, angles[best]) for column in columns) else []


def _angle(
    taken: Sequence[Taken], time: Float[np.ndarray, " time"] | None, known: Mapping[str, Any]
) -> Float[np.ndarray, " time"] | None:
    """Angle of the wave generator [rad]; by the set speed if it was not recorded."""
    for each in taken:
        if each.quantity == "phi_in" and each.entry["unit"] in FACTORS["rad"]:
            return unwrapped(each.column.values) * FACTORS["rad"][each.entry["unit"]]
        if each.quantity == "phi_in":
            return unwrapped(each.column.values) * 2 * pi / each.entry["per_revolution"]
    if time is None:
        return None
    for each in taken:
        if each.quantity == "n_in" and each.entry["unit"] in FACTORS["rad/s"]:
            mean = float(np.nanmean(each.column.values)) * FACTORS["rad/s"][each.entry["unit"]]
            return mean * (time - time[0])
    return float(known["n_in_rpm"]) * pi / 30 * (time - time[0]) if "n_in_rpm" in known else None


def _torques(torques: Sequence[Pair]) -> Iterator[Taken]:
    """Torques of the input and the output: by the names, else the larger one is that of the output."""
    ranked = sorted(torques, key=lambda pair: -_newton_metres(pair[0]))
    of_output = next((pair for pair in ranked if pair[1].says(OUTPUT)), None)
    of_input = next((pair for pair in ranked if pair[1].says(INPUT) and pair is not of_output), None)
    rest = [pair for pair in ranked if pair not in (of_output, of_input)]
    ask = "" if of_output else "torque at the output? it has the largest torque"
    if not of_output and rest:
        of_output = rest.pop(0)
    ask_in = "" if of_input else "torque at the input?"
    if not of_input and rest:
        of_input = rest.pop(0)
    for channel, pair, question in (("T_out", of_output, ask), ("T_in", of_input, ask_in)):
        if pair:
            column, meaning = pair
            unit = column.unit if column.unit in (*FACTORS["N m"], *OUTPUTS) else "N m"
            said = "" if column.unit else "no unit is said: N m is assumed"
            yield Taken(column, channel, place(column) | {"unit": unit}, meaning.why, question or said)


def _newton_metres(column: SeenColumn) -> float:
    """Mean torque, by which two are compared."""
    return abs(float(np.nanmean(column.values))) * FACTORS["N m"].get(column.unit, 1.0)
