"""Which mistake explains that an angle does not go as far as its velocity says."""

from math import pi

from swgsim.joint.intake.thresholds import NAMED, NAMED_HALF

# Way by the angle / way by the velocity.
MISTAKES = (
    ("angle_in_degrees", 180 / pi, "the angle is in degrees"),
    ("angle_in_revolutions", 1 / (2 * pi), "the angle is in revolutions"),
    ("velocity_in_deg_s", pi / 180, "the velocity is in degrees per second"),
    ("velocity_in_rpm", pi / 30, "the velocity is in revolutions per minute"),
    ("velocity_in_rev_s", 2 * pi, "the velocity is in revolutions per second"),
    ("time_unit", 1e-3, "the time is in milliseconds, or the velocity a thousand times too large"),
    ("time_unit", 1e3, "the time is a thousand times too small, or the velocity is"),
)
HALVES = (
    ("half_rate", 2.0, "every other row is missing, or the velocity is half of what it was"),
    ("double_rate", 0.5, "every row is there twice, or the velocity is twice of what it was"),
)


def mistake(ratio: float, gear_ratio: float | None) -> tuple[str, str] | None:
    """Kind of finding and likely reason; None if no mistake is known that has this ratio.

    Parameters
    ----------
    ratio : float
        Way by the angle over way by the velocity, without its sign.
    gear_ratio : float or None

    >>> mistake(57.0, None)
    ('angle_in_degrees', 'the angle is in degrees')
    """
    for kind, factor, reason in HALVES:
        if abs(ratio / factor - 1) < NAMED_HALF:
            return kind, reason
    if gear_ratio is not None and abs(ratio * gear_ratio - 1) < NAMED:
        return "velocity_of_motor", f"the velocity is that of the motor, {gear_ratio:g} times that of the output"
    if gear_ratio is not None and abs(ratio / gear_ratio - 1) < NAMED:
        return "angle_of_motor", f"the angle is that of the motor, {gear_ratio:g} times that of the output"
    return next(((kind, reason) for kind, factor, reason in MISTAKES if abs(ratio / factor - 1) < NAMED), None)
