"""One column of a file: what it is called there, and what its numbers mean."""

from dataclasses import dataclass
from math import pi

from swgsim.common.checks import require_known
from swgsim.joint.intake.units import FACTORS
from swgsim.joint.recording import SIGNALS

# A file with more columns than this is no table of joints; six joints of a UR10e have 31.
MOST_COLUMNS = 10_000


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
        In which it is written.
    inverted : bool
        Whether its sign is to be turned.
    wraps : bool
        Of an angle: whether it is kept within one revolution, so that its jumps are to be taken out.

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
            raise ValueError(f"wraps is said of {self.quantity}, but only the angle q can wrap: leave it out")
        numbered = isinstance(self.column, int)
        if numbered and not 1 <= int(self.column) <= MOST_COLUMNS:
            raise ValueError(f"column {self.column} of {self.quantity} must be a number from 1 to {MOST_COLUMNS}")
        if not numbered and not self.column:
            raise ValueError(f"the column of {self.quantity} has no name: give that of the file")

    @property
    def factor(self) -> float:
        """From the number in the file to the signal's."""
        return (-1.0 if self.inverted else 1.0) * FACTORS[self._target][self.unit]

    @property
    def revolution(self) -> float:
        """One revolution in the numbers of the file, of an angle."""
        return 2 * pi / FACTORS["rad"][self.unit]

    @property
    def _target(self) -> str:
        return "s" if self.quantity == "time" else SIGNALS[self.quantity].unit
