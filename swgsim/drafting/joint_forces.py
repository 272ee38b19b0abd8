"""Current and torques of a joint, and the columns of a robot's log with what their names say."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from swgsim.drafting.seen_column import SeenColumn
from swgsim.drafting.taken import Taken, place
from swgsim.drafting.vocabulary import COMMON, MODEL, MOTOR, OUTPUT, WORDS
from swgsim.drafting.words import Meaning
from swgsim.tables.units import FACTORS, SHARES

# Objects of drives (CiA 402) that are in per mille of a rated value, and those of the drive's own encoder.
OF_RATED = frozenset({"6077h", "6078h"})
OF_DRIVE = frozenset({"6064h", "606ch"})
# In ROS the torque by the motor's current, or by the controller.
EFFORT = frozenset({"effort", "efforts"})


@dataclass(frozen=True, eq=False)
class Named:
    """A column with what its name says."""

    column: SeenColumn
    meaning: Meaning

    @property
    def index(self) -> int | None:
        """The number in the name."""
        return self.meaning.index

    @property
    def words(self) -> tuple[str, ...]:
        """The words that tell its joint from others, such as shoulder."""
        known = (COMMON, MOTOR, OUTPUT, *WORDS.values())
        return tuple(word for word in self.meaning.words if not any(word in words for words in known))

    @property
    def joint(self) -> int | tuple[str, ...]:
        """What its name says of its joint: a number, else words."""
        return self.words if self.index is None else self.index

    @property
    def at_motor(self) -> bool:
        """Whether it is on the motor's side of the gear by its name."""
        return self.meaning.says(MOTOR) or self.meaning.says(OF_DRIVE)


def forces(
    angle: Named, currents: Sequence[Named], torques: Sequence[Named], alone: bool
) -> Iterator[tuple[str, Named]]:
    """Current and torques of a joint: for each signal the first column, measured ones before others."""

    def own(columns: Sequence[Named]) -> list[Named]:
        found = [each for each in columns if each.joint == angle.joint]
        return found or (list(columns) if alone else [])

    yield from (("current", each) for each in own(currents)[:1])
    measured = [each for each in own(torques) if not each.meaning.says(MODEL) and not each.at_motor]
    sensed = [each for each in measured if not each.meaning.says(EFFORT)]
    yield from (("T_sensor", each) for each in sorted(sensed, key=lambda each: not each.meaning.says(OUTPUT))[:1])
    yield from (("T_motor", each) for each in [each for each in measured if each.meaning.says(EFFORT)][:1])
    yield from (("T_rigid", each) for each in [each for each in own(torques) if each.meaning.says(MODEL)][:1])


def force(signal: str, each: Named, known: Mapping[str, Any]) -> Taken:
    """One current or torque."""
    column, target = each.column, "A" if signal == "current" else "N m"
    unit, more, ask, active = column.unit, {}, "", True
    if not unit and each.meaning.says(OF_RATED):
        unit = "permille"
    if unit in SHARES:
        more = {"rated": known.get("rated", f"1 {target}")}
        ask, active = ("", True) if "rated" in known else ("its rated value", False)
    elif unit not in FACTORS[target]:
        ask = "" if not unit else f"the file says {unit}"
        unit, ask = target, ask or f"no unit is said: {target} is assumed"
    if signal == "T_motor":
        ask = ask if unit in SHARES else "effort: torque of the motor, with friction; T_sensor if a sensor measured it"
    return Taken(column, signal, place(column) | {"unit": unit} | more, each.meaning.why, ask, "", active)
