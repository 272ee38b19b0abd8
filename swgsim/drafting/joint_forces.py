"""Current and torques of a joint."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from swgsim.drafting.draft_line import DraftLine, place
from swgsim.drafting.named_column import NamedColumn
from swgsim.drafting.vocabulary import MODEL, OUTPUT
from swgsim.tables.units import FACTORS, SHARES

# Objects of drives (CiA 402) that are in per mille of a rated value.
OF_RATED = frozenset({"6077h", "6078h"})
# In ROS the torque by the motor's current, or by the controller.
EFFORT = frozenset({"effort", "efforts"})


def forces(
    angle: NamedColumn, currents: Sequence[NamedColumn], torques: Sequence[NamedColumn], alone: bool
) -> Iterator[tuple[str, NamedColumn]]:
    """Current and torques of a joint: for each signal the first column, measured ones before others."""

    def own(columns: Sequence[NamedColumn]) -> list[NamedColumn]:
        found = [each for each in columns if each.joint == angle.joint]
        return found or (list(columns) if alone else [])

    yield from (("current", each) for each in own(currents)[:1])
    measured = [each for each in own(torques) if not each.meaning.says(MODEL) and not each.at_motor]
    sensed = [each for each in measured if not each.meaning.says(EFFORT)]
    yield from (("T_sensor", each) for each in sorted(sensed, key=lambda each: not each.meaning.says(OUTPUT))[:1])
    yield from (("T_motor", each) for each in [each for each in measured if each.meaning.says(EFFORT)][:1])
    yield from (("T_rigid", each) for each in [each for each in own(torques) if each.meaning.says(MODEL)][:1])


def force(signal: str, each: NamedColumn, known: Mapping[str, Any]) -> DraftLine:
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
    return DraftLine(column, signal, place(column) | {"unit": unit} | more, each.meaning.why, ask, "", active)
