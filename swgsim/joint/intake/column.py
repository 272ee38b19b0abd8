"""One column of a file: its name there, and the meaning of its numbers."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi

from swgsim.common.checks import require_known
from swgsim.joint.recording import SIGNALS
from swgsim.tables.units import FACTORS as OF_CHANNELS

# No table of joints has more columns; six joints of a UR10e have 31.
MOST_COLUMNS = 10_000
# Factor from the unit of a column to the SI unit of its signal, by SI unit.
FACTORS: Mapping[str, Mapping[str, float]] = {
    "s": OF_CHANNELS["s"],
    "rad": OF_CHANNELS["rad"],
    "rad/s": {"rad/s": 1.0, "deg/s": pi / 180, "rpm": pi / 30, "rev/s": 2 * pi},
    "N m": OF_CHANNELS["N m"],
    "A": {"A": 1.0, "mA": 1e-3},
}


@dataclass(frozen=True)
class Column:
    """A column.

    Attributes
    ----------
    quantity : str
        ``time`` or a name of :data:`swgsim.joint.recording.SIGNALS`.
    column : str or int
        Its name, or its number from 1 where the files have no header.
    unit : str
        Unit of its numbers.
    inverted : bool
        Whether the sign is changed.
    wraps : bool
        Whether an angle is wrapped to one revolution, so that its jumps are removed.

    Raises
    ------
    ValueError
        If the quantity or the unit is unknown.
    """

    quantity: str
    column: str | int
    unit: str
    inverted: bool = False
    wraps: bool = False

    def __post_init__(self) -> None:
        require_known("signals", [self.quantity], ["time", *SIGNALS])
        require_known(f"the unit of {self.quantity}", [self.unit], FACTORS[self._target])
        if self.wraps and self.quantity != "q":
            raise ValueError(f"wraps is set for {self.quantity}, but only the angle q can wrap: leave it out")
        numbered = isinstance(self.column, int)
        if numbered and not 1 <= int(self.column) <= MOST_COLUMNS:
            raise ValueError(f"column {self.column} of {self.quantity} must be a number from 1 to {MOST_COLUMNS}")
        if not numbered and not self.column:
            raise ValueError(f"the column of {self.quantity} has no name: give the name in the file")

    @property
    def factor(self) -> float:
        """Factor from the number in the file to the signal."""
        return (-1.0 if self.inverted else 1.0) * FACTORS[self._target][self.unit]

    @property
    def revolution(self) -> float:
        """One revolution of an angle in the unit of the file."""
        return 2 * pi / FACTORS["rad"][self.unit]

    @property
    def _target(self) -> str:
        return "s" if self.quantity == "time" else SIGNALS[self.quantity].unit
