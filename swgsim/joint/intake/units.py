"""Units that a source may name for the signals of a joint, and the factors to SI units."""

from collections.abc import Mapping
from math import pi

from swgsim.recordings.files.units import FACTORS as OF_CHANNELS

# From the unit of a column to that of the signal (swgsim/joint/recording.py), by the signal's unit.
FACTORS: Mapping[str, Mapping[str, float]] = {
    "s": OF_CHANNELS["s"],
    "rad": OF_CHANNELS["rad"],
    "rad/s": {"rad/s": 1.0, "deg/s": pi / 180, "rpm": pi / 30, "rev/s": 2 * pi},
    "N m": OF_CHANNELS["N m"],
    "A": {"A": 1.0, "mA": 1e-3},
}
