"""Reading of a source from plain YAML; an unknown key is refused with the list of known keys."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from swgsim.common.checks import require_known
from swgsim.joint.intake.source import JointColumns, JointSource
from swgsim.joint.recording import SIGNALS
from swgsim.tables.clock import read_clock
from swgsim.tables.file_defect import shown
from swgsim.tables.measured_column import MOST_COLUMNS, MeasuredColumn, number, read_column, text, truth
from swgsim.tables.plain_file import described, require_names
from swgsim.tables.table_map import KEYS as OF_TABLE
from swgsim.tables.table_map import read_table_map
from swgsim.tables.units import FACTORS, known_unit

KEYS = (
    "robot", "files", "rest", "leave_out", "time", "rate", "rate_hz", "start_up", "joints", "posture", "others_stand",
    *OF_TABLE,
)  # fmt: skip
FROM_MOTION, FROM_ANGLE, MOTOR = "from_motion", "from_angle", "motor"
# Window of a velocity from the angle [s], where the source has none: motions of robots are slower.
SMOOTHING_WINDOW = 0.05


def read_source(path: Path) -> JointSource:
    """A source from a YAML file.

    Raises
    ------
    FileDefect
        If it is not YAML, or has an unknown key or value; the choices are listed.
    """
    return described(path, "a source", "conf/sources/kinova_gen3.yaml", _source)


def _source(config: Any) -> JointSource:
    """A source from plain data."""
    require_names("the source", config, KEYS)
    for name in ("robot", "files", "joints"):
        if name not in config:
            raise ValueError(f"the source has no {name}")
    rate = config.get("rate", FROM_MOTION)
    if rate != FROM_MOTION:
        raise ValueError(f"rate is {shown(rate)}, must be {FROM_MOTION}; a number belongs to rate_hz")
    start = config.get("start_up", {})
    require_names("start_up", start, ("samples", "seconds"))
    if len(start) > 1:
        raise ValueError("start_up has both samples and seconds: keep one")
    require_names("joints", config["joints"])
    table = read_table_map(config)
    return JointSource(
        robot=text("robot", config["robot"]),
        files=_patterns("files", config["files"]),
        joints=tuple(_joint(name, entry, table.interleaved) for name, entry in config["joints"].items()),
        rest=_patterns("rest", config.get("rest", [])),
        leave_out=_patterns("leave_out", config.get("leave_out", [])),
        table=table,
        clock=read_clock(config["time"]) if "time" in config else None,
        rate_hz=number("rate_hz", config),
        rate_from_motion="rate" in config,
        start_samples=start.get("samples", 0),
        start_seconds=number("seconds", start, 0.0) or 0.0,
        posture=_posture(config.get("posture"), table.interleaved),
        others_stand=truth("others_stand", config.get("others_stand", False)),
    )


def _joint(name: str, entry: Any, interleaved: int) -> JointColumns:
    require_names(name, entry, ("signals", "gear_ratio", "torque_constant"))
    require_names(f"signals of {name}", entry.get("signals"))
    ratio, constant = (number(key, entry) for key in ("gear_ratio", "torque_constant"))
    signals = dict(entry["signals"])
    smoothed = _smoothed(signals.pop("omega")) if _from_angle(signals.get("omega")) else None
    require_known(f"signals of {name}", signals, SIGNALS)
    columns = tuple(_signal(signal, column, ratio, interleaved) for signal, column in signals.items())
    return JointColumns(text("joint", name), columns, ratio, constant, smoothed)


def _signal(signal: str, entry: Any, gear_ratio: float | None, interleaved: int) -> MeasuredColumn:
    """A signal of a joint; angle and velocity of the motor are divided by the gear ratio."""
    if signal == "current" and isinstance(entry, Mapping) and known_unit(str(entry.get("unit"))) in FACTORS["N m"]:
        raise ValueError(f"current is in {entry['unit']}, which is a torque: map it as T_motor")
    moves = signal in ("q", "omega")
    column = read_column(signal, entry, SIGNALS[signal].unit, ("at",) if moves else (), interleaved)
    side = entry.get("at", "output")
    require_known(f"at of {signal}", [text(f"at of {signal}", side)], ["output", MOTOR])
    if side != MOTOR:
        return column
    if gear_ratio is None:
        raise ValueError(f"{signal} is that of the motor, but the joint has no gear_ratio: give it")
    return replace(column, gain=column.gain / gear_ratio, offset=column.offset / gear_ratio)


def _from_angle(entry: Any) -> bool:
    return entry == FROM_ANGLE or (isinstance(entry, Mapping) and "from" in entry)


def _smoothed(entry: Any) -> float:
    """Window of a velocity from the angle [s]."""
    if entry == FROM_ANGLE:
        return SMOOTHING_WINDOW
    require_names("omega", entry, ("from", "smoothed_s"))
    if entry["from"] != "q":
        raise ValueError(f"from of omega is {shown(entry['from'])}, must be q")
    return number("smoothed_s", entry, SMOOTHING_WINDOW) or 0.0


def _posture(entry: Any, interleaved: int) -> tuple[MeasuredColumn, ...]:
    if entry is None:
        return ()
    require_names("posture", entry, ("columns", "unit", "file"))
    columns, shared = entry.get("columns"), {key: entry[key] for key in ("unit", "file") if key in entry}
    if not isinstance(columns, list) or not 1 <= len(columns) <= MOST_COLUMNS:
        raise ValueError(
            f"columns of posture is {shown(columns)}, must be a list: joints with parallel level axes, from base to tip"
        )
    return tuple(read_column("posture", {"column": each, **shared}, "rad", (), interleaved) for each in columns)


def _patterns(name: str, value: Any) -> tuple[str, ...]:
    patterns: Sequence[Any] = value if isinstance(value, list) else [value]
    for pattern in patterns:
        found = text(name, pattern)
        if found.startswith("/") or "\\" in found or ".." in found.split("/"):
            raise ValueError(f"{name} has {shown(found)}, must be a pattern inside the folder, such as runs/*.csv")
    return tuple(patterns)
