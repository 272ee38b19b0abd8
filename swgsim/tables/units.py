"""Units of column maps, and their factors to the units of the channels."""

from collections.abc import Mapping
from math import pi

# Unit of the channel (swgsim/recordings/recording.py) to unit of the column and factor between them.
FACTORS: Mapping[str, Mapping[str, float]] = {
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6},
    "rad": {"rad": 1.0, "deg": pi / 180, "rev": 2 * pi},
    "rpm": {"rpm": 1.0, "rad/s": 30 / pi, "deg/s": 1 / 6, "rev/s": 60.0},
    "N m": {"N m": 1.0, "mN m": 1e-3, "kN m": 1e3},
    "mV/V": {"mV/V": 1.0, "V/V": 1e3, "uV/V": 1e-3},
}
STRAIN = "um/m"


def bridge_factor(gauge_factor: float, active_arms: int) -> float:
    """Bridge signal [mV/V] per strain [um/m] of each active arm: k / 4 for one arm.

    >>> bridge_factor(2.0, 4)
    0.002
    """
    return gauge_factor / 4 * active_arms * 1e-3
