"""Angles and velocities by their numbers: jumps of a wrapped angle, and its slope, which is the velocity."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, Shaped
from scipy.integrate import cumulative_trapezoid

from swgsim.tables.units import FACTORS

# Relative deviation at which two numbers are the same: 57.3 (degrees) and 60 (rpm) differ by 5 %.
RATIO_TOLERANCE = 0.02
# Largest revolution of an encoder that counts [counts].
MOST_BITS = 32
# Gears of one stage.
RATIOS = (20.0, 400.0)
ANGLE_UNITS = ("rad", "deg", "rev", "mrad")
SPEED_UNITS = ("rad/s", "deg/s", "rpm", "rev/s")
# Share of an angle that a velocity must explain to be its velocity, where the names do not say so.
LEAST_EXPLAINED = 0.99


class Wrap(NamedTuple):
    """What a wrapped angle grows by in one revolution, and its unit."""

    revolution: float
    unit: str


class Slope(NamedTuple):
    """An angle against the integral of a velocity.

    Attributes
    ----------
    factor : float
        Change of the angle per velocity and second, in the units of the columns.
    share : float
        Share of the angle's variance that it explains.
    """

    factor: float
    share: float


def wrap_of(values: Shaped[np.ndarray, " time"]) -> Wrap | None:
    """The revolution of an angle that jumps back by one; None for an angle that does not.

    >>> wrap_of(np.mod(np.arange(0, 900, 7.0), 360))
    Wrap(revolution=360.0, unit='deg')
    """
    angle = values[np.isfinite(values.astype(float))].astype(float)
    steps, span = np.diff(angle), float(np.ptp(angle)) if len(angle) else 0.0
    jumps = np.abs(steps) > 0.5 * span
    if not span or not jumps.any() or jumps.sum() > 0.25 * len(steps):
        return None
    usual = np.abs(steps[~jumps])
    # The angle moves on in the step of its jump, by about as much as in those beside it.
    size = float(np.median(np.abs(steps[jumps]))) + float(np.median(usual))
    known = {"deg": 360.0, "rad": 2 * np.pi, "rev": 1.0}
    known |= {f"counts {bits}": 2.0**bits for bits in range(8, MOST_BITS + 1)}
    unit = min(known, key=lambda each: abs(np.log(size / known[each])))
    if abs(size / known[unit] - 1) > RATIO_TOLERANCE or span > known[unit] * (1 + RATIO_TOLERANCE):
        return None
    return Wrap(known[unit], unit.split()[0])


def unwrapped(values: Shaped[np.ndarray, " time"]) -> Float[np.ndarray, " time"]:
    """An angle without jumps, lost readings filled in."""
    angle, wrap = filled(values), wrap_of(values)
    return np.unwrap(angle, period=wrap.revolution) if wrap else angle


def turns_of(values: Shaped[np.ndarray, " time"], entry: Mapping[str, Any]) -> float:
    """Turns of an angle from end to end, by its unit in a map."""
    per_turn = entry.get("per_revolution") or 2 * np.pi / FACTORS["rad"][entry["unit"]]
    return float(np.ptp(unwrapped(values))) / per_turn


def filled(values: Shaped[np.ndarray, " time"]) -> Float[np.ndarray, " time"]:
    """Numbers whose lost readings lie on lines between their neighbours."""
    found = values.astype(float)
    sound = np.isfinite(found)
    if sound.all() or not sound.any():
        return found
    return np.interp(np.arange(len(found)), np.flatnonzero(sound), found[sound])


def slope_of(
    angle: Shaped[np.ndarray, " time"], speed: Shaped[np.ndarray, " time"], time: Float[np.ndarray, " time"] | None
) -> Slope:
    """Compare an angle with the integral of a velocity, which noise spoils less than a slope.

    Without a time its factor is per sample.
    """
    q, w = unwrapped(angle), filled(speed)
    moved = cumulative_trapezoid(w, None if time is None else filled(time), initial=0.0)
    q, moved = q - q.mean(), moved - moved.mean()
    power = float(moved @ moved)
    if not power or not float(q @ q):
        return Slope(0.0, 0.0)
    factor = float(q @ moved) / power
    return Slope(factor, 1 - float(np.sum((q - factor * moved) ** 2)) / float(q @ q))


def expected(angle_unit: str, speed_unit: str) -> float:
    """The factor of a slope between two units.

    >>> round(expected("deg", "rad/s"), 1)
    57.3
    """
    return FACTORS["rad/s"][speed_unit] / FACTORS["rad"][angle_unit]


def near(found: float, wanted: float) -> bool:
    """Whether two numbers are the same but for noise."""
    return bool(wanted) and abs(found / wanted - 1) < RATIO_TOLERANCE
