"""Likely reasons for a deviation from the set speed."""

from math import pi

from swgsim.recordings.checks.thresholds import RATIOS, UNIT_TOLERANCE

# Found speed / set speed, for an angle over time and for a recorded speed.
ANGLE_MISTAKES = (
    ("angle_in_degrees", 180 / pi, "the angle is in degrees"),
    ("angle_in_revolutions", 1 / (2 * pi), "the angle is in revolutions"),
    ("angle_against_set_speed", 1 / 1000, "the time is in milliseconds"),
    ("angle_against_set_speed", 1000.0, "the time is in units of 1000 s"),
)
SPEED_MISTAKES = (
    ("speed_in_rad_s", 2 * pi / 60, "the speed is in rad/s"),
    ("speed_in_rev_s", 1 / 60, "the speed is in revolutions per second"),
    ("speed_in_deg_s", 6.0, "the speed is in degrees per second"),
)
# Mistakes of the set speed affect angle and speed alike.
SET_MISTAKES = (
    (60 / (2 * pi), "the set speed is in rad/s"),
    (60.0, "the set speed is in revolutions per second"),
    (2 * pi / 60, "the set speed was multiplied by 60 / 2 pi once too often"),
    (1 / 60, "a factor of 60 is missing"),
)


def mistake(ratio: float, mistakes: tuple[tuple[str, float, str], ...], otherwise: str) -> tuple[str, str]:
    """Kind of defect and its likely reason.

    Parameters
    ----------
    ratio : float
        Found speed over set speed, without its sign.
    mistakes : tuple
        Mistakes of the quantity.
    otherwise : str
        Kind for any other reason.

    >>> mistake(57.3, ANGLE_MISTAKES, "angle_against_set_speed")
    ('angle_in_degrees', 'the angle is in degrees')
    """
    for kind, factor, reason in mistakes:
        if abs(ratio / factor - 1) < UNIT_TOLERANCE:
            return kind, reason
    reasons = [reason for factor, reason in SET_MISTAKES if abs(ratio / factor - 1) < UNIT_TOLERANCE]
    low, high = RATIOS
    if low <= 1 / ratio <= high:
        reasons.append(f"it is the speed of the output of a gear of ratio {1 / ratio:.0f}")
    if low <= ratio <= high:
        reasons.append(f"the set speed is that of the output of a gear of ratio {ratio:.0f}")
    return otherwise, "; or ".join(reasons) or "unit, encoder lines or set point are wrong"
