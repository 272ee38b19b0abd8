"""Units of an angle and of its velocity, from what the columns say and from the factor between slope and velocity."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from math import log2, pi
from typing import Any

import numpy as np
from jaxtyping import Float

from swgsim.drafting.file_column import FileColumn
from swgsim.drafting.motion import ANGLE_UNITS, RATIOS, SPEED_UNITS, Slope, expected, near, slope_of, wrap_of
from swgsim.tables.units import FACTORS, SHARES

# An angle in whole numbers with a larger range counts; 720 degrees may be written without decimals.
COUNTED = 1000.0
# Share of an angle that its velocity explains; a dead band or a wrong column explains less.
FITS = 0.9
# Most robots turn less to either side; beyond, an angle without unit is in degrees [rad].
MOST_TURNED = 4 * pi


@dataclass(frozen=True)
class MotionUnits:
    """What a map says of an angle and its velocity besides their columns.

    Attributes
    ----------
    angle, speed : dict
        ``unit`` and more.
    ratio : float
        Turns of the shaft of the velocity per turn of that of the angle.
    why : str
    of_angle, of_speed : str
        What the user must decide.
    fits : bool
        Whether the velocity is that of the angle.
    """

    angle: dict[str, Any]
    speed: dict[str, Any] = field(default_factory=dict)
    ratio: float = 1.0
    why: str = ""
    of_angle: str = ""
    of_speed: str = ""
    fits: bool = True


def motion_units(
    angle: FileColumn, speed: FileColumn | None, time: Float[np.ndarray, " time"] | None, likely: Sequence[str] = ()
) -> MotionUnits:
    """Units of an angle and of its velocity.

    Parameters
    ----------
    angle : FileColumn
    speed : FileColumn, optional
    time : array (time,), optional
        [s]; without it the factor of the slope says nothing.
    likely : sequence of str
        Units of an angle that says none, the most likely first.
    """
    if speed is not None and speed.unit in SHARES:
        alone = motion_units(angle, None, time, likely)
        return _of_rated(alone, speed.unit, slope_of(angle.values, speed.values, time), time is not None)
    wrap = wrap_of(angle.values)
    wraps = {"wraps": True} if wrap else {}
    said = angle.unit if angle.unit in (*FACTORS["rad"], "counts") else ""
    units = [wrap.unit] if wrap else [said] if said else list(likely) or _likely(angle)
    doubt = f"the file says {said}, its jumps say {wrap.unit}" if wrap and said not in ("", wrap.unit) else ""
    if not (said or wrap) and _counts(angle):
        units = ["counts"]
    rates = [speed.unit] if speed is not None and speed.unit in (*FACTORS["rad/s"], "counts/s") else list(SPEED_UNITS)
    slope = slope_of(angle.values, speed.values, time) if speed is not None else None
    if "counts" in units:
        return _counted(slope.factor if slope else 0.0, rates, wrap.revolution if wrap else 0.0, wraps)
    asked = "" if said or wrap else f"no unit is said: {units[0]} is assumed"
    draft = MotionUnits({"unit": units[0], **wraps}, of_angle=doubt or asked)
    if slope is None:
        return draft
    if slope.share < FITS:
        of_speed = f"{max(slope.share, 0):.0%} of {angle.column} is its integral, so omega is the slope of the angle"
        return replace(draft, speed={"unit": rates[0]}, of_speed=of_speed, fits=False)
    turned = {"inverted": True} if slope.factor < 0 else {}
    draft = replace(draft, speed={"unit": rates[0], **turned})
    if time is None:
        return replace(draft, of_speed="no time, by which its unit could be checked")
    of_speed = "its sign is against the slope of the angle" if turned else ""
    found = abs(slope.factor)
    share = f"slope explains {slope.share:.1%}"
    pairs = [pair for pair in product(units, rates) if near(found, expected(*pair))]
    if pairs:
        unit, rate = pairs[0]
        why = share if len(units) == len(rates) == 1 else f"{share}, factor {found:.4g}: {rate} and {unit}"
        sure = len({pair[0] for pair in pairs}) == 1
        return MotionUnits(
            {"unit": unit, **wraps}, {"unit": rate, **turned}, 1.0, why, doubt or asked * (not sure), of_speed
        )
    ratio = expected(units[0], rates[0]) / found
    if RATIOS[0] <= max(ratio, 1 / ratio) <= RATIOS[1]:
        why = f"{share}, {max(ratio, 1 / ratio):.4g} turns for one"
        return replace(draft, ratio=ratio, why=why, of_speed=of_speed)
    contradiction = f"as {rates[0]} it is {1 / ratio:.4g} times too small for the slope of the angle in {units[0]}"
    return replace(draft, why=share, of_speed=contradiction)


def _of_rated(angle: MotionUnits, unit: str, slope: Slope, timed: bool) -> MotionUnits:
    """A velocity in shares of a rated one, which the slope of the angle tells."""
    fits = timed and slope.share > FITS and angle.angle["unit"] != "counts"
    rated = f"{abs(slope.factor) / SHARES[unit]:.4g} {angle.angle['unit']}/s" if fits else "1 rad/s"
    speed = {"unit": unit, "rated": rated} | ({"inverted": True} if slope.factor < 0 else {})
    of_speed = f"its rated value: {rated} by the slope of the angle" if fits else "its rated value"
    return replace(angle, speed=speed, why=f"slope explains {slope.share:.1%}", of_speed=of_speed, fits=fits)


def _likely(angle: FileColumn) -> list[str]:
    """Units of an angle that says none, by its range."""
    units = list(ANGLE_UNITS)
    return ["deg", *units] if np.nanmax(np.abs(angle.values.astype(float))) > MOST_TURNED else units


def _counts(angle: FileColumn) -> bool:
    """Whether an angle counts."""
    values = angle.values.astype(float)
    return bool(np.ptp(values) > COUNTED and np.all(values == np.round(values)))


def _counted(factor: float, rates: Sequence[str], revolution: float, wraps: dict[str, Any]) -> MotionUnits:
    """An angle in counts of an encoder, whose counts of one revolution follow from a velocity in other units."""
    found = abs(factor)
    turns = {rate: 2 * pi * found / FACTORS["rad/s"][rate] for rate in rates if rate != "counts/s"} or {"rpm": 0.0}
    whole = [rate for rate, per in turns.items() if per > 1 and near(per, revolution or 2 ** round(log2(per)))]
    speed: dict[str, Any] = {"unit": "counts/s" if near(found, 1.0) else [*whole, *turns][0]}
    per = revolution or turns.get(speed["unit"], 0.0)
    lines = 2 ** round(log2(per)) if per > 1 else 0
    sure = per > 1 and near(per, lines)
    counts = lines if sure else float(f"{per:.4g}") if per > 1 else 4096
    why = f"its slope: {per:.6g} counts of one turn" if per else ""
    asked = "" if sure else f"counts of one revolution{f': about {per:.4g} by the velocity' if per else ''}"
    more = {"per_revolution": counts}
    of_speed = asked if speed["unit"] == "counts/s" else ""
    speed |= more if speed["unit"] == "counts/s" else {}
    return MotionUnits({"unit": "counts", **more, **wraps}, speed, 1.0, why, asked, of_speed)
