"""Signals of the joints of a robot: which column is whose angle, velocity, current and torque."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
from jaxtyping import Float

from swgsim.drafting.draft_line import DraftLine, joined, place
from swgsim.drafting.file_column import FileColumn
from swgsim.drafting.joint_forces import force, forces
from swgsim.drafting.motion import LEAST_EXPLAINED, RATIOS, slope_of, turns_of, wrap_of
from swgsim.drafting.motion_units import MOST_TURNED, motion_units
from swgsim.drafting.named_column import NamedColumn
from swgsim.drafting.vocabulary import MODEL
from swgsim.drafting.words import Meaning
from swgsim.tables.units import FACTORS, SHARES

# Turns from end to end beyond which an angle is that of a motor.
MOST_TURNS = MOST_TURNED / np.pi


def joint_signals(
    named: Sequence[NamedColumn],
    time: Float[np.ndarray, " time"] | None,
    known: Mapping[str, Any],
) -> list[DraftLine]:
    """What the columns of a robot's log are taken for; those that are not understood come last.

    Parameters
    ----------
    named : sequence of NamedColumn
        The columns that are no time.
    time : array (time,), optional
        [s]; None if no time was found.
    known : mapping
        Facts of the user, such as ``gear_ratio``.
    """
    usable = [each for each in named if not each.column.is_text and not _is_set_point(each.meaning)]
    kinds = {kind: [each for each in usable if each.meaning.quantity == kind] for kind in ("angle", "speed", "current")}
    torques = [each for each in usable if each.meaning.quantity == "torque"]
    unnamed = [each for each in usable if not each.meaning.quantity and not each.column.stands]
    angles = _one_for_each_joint(kinds["angle"])
    pairs = _by_slope(unnamed, time) if not angles else {}
    # A column that jumps by one turn is an angle, whatever its name.
    angles = angles or list(pairs) or [each for each in unnamed if wrap_of(each.column.values)]
    joints = _names(angles)
    drafted: list[DraftLine] = []
    if not joints and usable:
        # A source needs an angle: the user must say which column it is.
        drafted.append(
            DraftLine(
                usable[0].column, "q", place(usable[0].column) | {"unit": "rad"}, "", "no angle was found", "joint_1"
            )
        )
    for name, angle in joints.items():
        alone = len(joints) == 1
        speed = pairs.get(angle) or _velocity(angle, kinds["speed"], time, alone)
        motor = next(
            (each for each in kinds["angle"] if each is not angle and each.joint == angle.joint and each.at_motor), None
        )
        drafted += _moving(name, angle, speed, motor, time, known)
        for signal in forces(angle, kinds["current"], torques, alone):
            drafted.append(replace(force(*signal, known), joint=name))
    left = [each for each in unnamed if each.column not in [one.column for one in drafted]]
    drafted += _suggested([each for each in left if pairs or each.column.unit in SHARES], list(joints), known)
    used = {id(each.column) for each in drafted}
    return drafted + [DraftLine(each.column, "", why=_why_not(each)) for each in named if id(each.column) not in used]


def _is_set_point(meaning: Meaning) -> bool:
    """Whether a value was asked for; the torque that a model asks for is a signal of its own."""
    return meaning.is_set_point and not (meaning.quantity == "torque" and meaning.says(MODEL))


def _one_for_each_joint(angles: Sequence[NamedColumn]) -> list[NamedColumn]:
    """One angle for each joint: that of the output before that of the motor."""
    chosen: dict[int | tuple[str, ...], NamedColumn] = {}
    for each in sorted(angles, key=lambda each: each.at_motor):
        chosen.setdefault(each.joint, each)
    return [each for each in angles if each in chosen.values()]


def _by_slope(
    columns: Sequence[NamedColumn], time: Float[np.ndarray, " time"] | None
) -> dict[NamedColumn, NamedColumn]:
    """Angles and their velocities among columns without names: a velocity explains its angle best, and an angle too."""
    shares = {
        (angle, speed): slope_of(angle.column.values, speed.column.values, time).share
        for angle, speed in product(columns, columns)
        if angle is not speed
    }
    found: dict[NamedColumn, NamedColumn] = {}
    for (angle, speed), share in sorted(shares.items(), key=lambda item: -item[1]):
        # A velocity is no angle itself, though its slope, the acceleration, may be among the columns.
        if (
            share > LEAST_EXPLAINED
            and angle not in {*found, *found.values()}
            and speed not in {*found, *found.values()}
        ):
            found[angle] = speed
    return {angle: found[angle] for angle in columns if angle in found}


def _names(angles: Sequence[NamedColumn]) -> dict[str, NamedColumn]:
    """Joints by their names: those of the columns, or joint_1 and so on by their numbers, else by their order."""
    words = ["_".join(each.words) for each in angles]
    if len(angles) > 1 and all(words) and len(set(words)) == len(words):
        return dict(zip(words, angles, strict=True))
    indices = [each.index for each in angles if each.index is not None]
    if len(angles) == 1 or len(set(indices)) < len(angles):
        return {f"joint_{number}": each for number, each in enumerate(angles, 1)}
    first = 1 if 0 in indices else 0
    return {f"joint_{index + first}": each for index, each in zip(indices, angles, strict=True)}


def _velocity(
    angle: NamedColumn, speeds: Sequence[NamedColumn], time: Float[np.ndarray, " time"] | None, alone: bool
) -> NamedColumn | None:
    """The velocity of an angle: that of the same joint which explains it best."""
    own = [each for each in speeds if each.joint == angle.joint] or (list(speeds) if alone else [])
    return max(own, key=lambda each: slope_of(angle.column.values, each.column.values, time).share, default=None)


def _moving(
    name: str, angle: NamedColumn, speed: NamedColumn | None, motor: NamedColumn | None,
    time: Float[np.ndarray, " time"] | None, known: Mapping[str, Any],
) -> Iterator[DraftLine]:  # fmt: skip
    """Angle and velocity of one joint."""
    units = motion_units(angle.column, speed.column if speed else None, time)
    turns = turns_of(angle.column.values, units.angle)
    drive = angle.at_motor or units.ratio < 1 / RATIOS[0] or turns > MOST_TURNS
    # The rated value of a share is that of the shaft of the angle, from which it follows.
    named = speed is not None and speed.at_motor and speed.column.unit not in SHARES
    of_motor = named or units.ratio > RATIOS[0]
    if abs(units.ratio - 1) < 0.5 and speed is not None:
        # One turn of the angle is one of the velocity: both are on one side.
        of_motor = drive = drive or of_motor
    ratio, ask = known.get("gear_ratio"), ""
    if units.ratio != 1 and ratio is None:
        ratio = round(max(units.ratio, 1 / units.ratio))
    elif motor is not None and ratio is None:
        found = ratio_of_angles(motor.column, angle.column)
        ratio = round(found) if RATIOS[0] <= found <= RATIOS[1] else None
    if (drive or of_motor) and ratio is None:
        far = f", as it turns {turns:.3g} times; if it is not, remove each 'at: motor'" if turns > MOST_TURNS else ""
        ratio, ask = 1, f"gear ratio: the angle is that of the motor{far}"
    side = {"at": "motor"}
    yield DraftLine(
        angle.column, "q", place(angle.column) | units.angle | (side if drive else {}),
        joined(angle.meaning.why, "" if speed else units.why, "jumps by one turn" if "wraps" in units.angle else ""),
        units.of_angle, name,
    )  # fmt: skip
    if ratio is not None:
        why = "" if ask else "given" if "gear_ratio" in known else units.why or "angles of motor and output"
        yield DraftLine(angle.column, "gear_ratio", {"gear_ratio": ratio}, why, ask, name)
    if speed is not None:
        entry = place(speed.column) | units.speed | (side if of_motor else {})
        yield DraftLine(
            speed.column, "omega", entry, joined(speed.meaning.why, units.why), units.of_speed, name, units.fits
        )


def ratio_of_angles(motor: FileColumn, output: FileColumn) -> float:
    """Turns of the motor per turn of the output, from two angles in known units; 0 if they do not say it."""
    if motor.unit not in FACTORS["rad"] or output.unit not in FACTORS["rad"]:
        return 0.0
    fast, slow = (each.values.astype(float) * FACTORS["rad"][each.unit] for each in (motor, output))
    return float(abs(np.polyfit(slow, fast, 1)[0])) if np.ptp(slow) > 0 else 0.0


def _suggested(columns: Sequence[NamedColumn], joints: Sequence[str], known: Mapping[str, Any]) -> Iterator[DraftLine]:
    """Lines for columns without names that come one for each joint, which the user may turn into signals."""
    for each, joint in zip(columns, joints if len(columns) >= len(joints) else [], strict=False):
        found = force("current", each, known)
        rated = "its rated value" if found.entry["unit"] in SHARES else ""
        ask = joined("current, T_motor, T_sensor or T_rigid?", rated)
        yield replace(found, question=ask, joint=joint, active=False)


def _why_not(each: NamedColumn) -> str:
    """Why a column is not taken."""
    if each.column.is_text:
        return "text"
    if each.meaning.is_set_point:
        return "a set point"
    if each.column.stands:
        return "always the same"
    return each.meaning.quantity and f"{each.meaning.quantity}, not needed"
