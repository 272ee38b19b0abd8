"""Reading of a source from plain YAML; an unknown key is refused with the list of known keys."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from swgsim.joint.intake.column import MOST_COLUMNS, Column
from swgsim.joint.intake.source import JointColumns, JointSource
from swgsim.tables.file_defect import shown
from swgsim.tables.plain_file import described, require_names

KEYS = (
    "robot", "path", "files", "rest", "leave_out", "header", "time", "rate", "rate_hz", "start_up", "joints", "posture",
    "others_stand",
)  # fmt: skip
FROM_MOTION = "from_motion"
LONGEST_TEXT = 1000


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
    for name in ("robot", "path", "files", "joints"):
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
    return JointSource(
        robot=_text("robot", config["robot"]),
        path=_text("path", config["path"]),
        files=_patterns("files", config["files"]),
        rest=_patterns("rest", config.get("rest", [])),
        leave_out=_patterns("leave_out", config.get("leave_out", [])),
        joints=tuple(_joint(name, entry) for name, entry in config["joints"].items()),
        header=_truth("header", config.get("header", True)),
        time=_column("time", config["time"]) if "time" in config else None,
        rate_hz=_number("rate_hz", config.get("rate_hz")),
        rate_from_motion="rate" in config,
        start_samples=start.get("samples", 0),
        start_seconds=_number("seconds of start_up", start.get("seconds", 0.0)) or 0.0,
        posture=_posture(config.get("posture")),
        others_stand=_truth("others_stand", config.get("others_stand", False)),
    )


def _joint(name: str, entry: Any) -> JointColumns:
    require_names(name, entry, ("signals", "gear_ratio", "torque_constant"))
    require_names(f"signals of {name}", entry.get("signals"))
    signals = tuple(_column(signal, column) for signal, column in entry["signals"].items())
    gear_ratio, constant = (_number(f"{key} of {name}", entry.get(key)) for key in ("gear_ratio", "torque_constant"))
    return JointColumns(_text("joint", name), signals, gear_ratio, constant)


def _column(quantity: str, entry: Any) -> Column:
    choices = ("column", "unit", *(() if quantity == "time" else ("inverted", "wraps")))
    require_names(quantity, entry, choices)
    switches = {name: _truth(f"{name} of {quantity}", entry.get(name, False)) for name in ("inverted", "wraps")}
    return Column(quantity, _column_name(quantity, entry.get("column")), _text("unit", entry.get("unit")), **switches)


def _posture(entry: Any) -> tuple[Column, ...]:
    if entry is None:
        return ()
    require_names("posture", entry, ("columns", "unit"))
    columns, unit = entry.get("columns"), _text("unit of posture", entry.get("unit"))
    if not isinstance(columns, list) or not 1 <= len(columns) <= MOST_COLUMNS:
        raise ValueError(
            f"columns of posture is {shown(columns)}, must be a list: joints with parallel level axes, from base to tip"
        )
    return tuple(Column("q", _column_name("posture", column), unit) for column in columns)


def _column_name(owner: str, value: Any) -> str | int:
    if isinstance(value, int) and not isinstance(value, bool):
        return value
    return _text(f"column of {owner}", value)


def _patterns(name: str, value: Any) -> tuple[str, ...]:
    patterns: Sequence[Any] = value if isinstance(value, list) else [value]
    for pattern in patterns:
        text = _text(name, pattern)
        if text.startswith("/") or "\\" in text or ".." in text.split("/"):
            raise ValueError(f"{name} has {shown(text)}, must be a pattern inside the folder, such as runs/*.csv")
    return tuple(patterns)


def _text(name: str, value: Any) -> str:
    if not isinstance(value, str) or not value or not value.isprintable() or len(value) > LONGEST_TEXT:
        raise ValueError(f"{name} is {shown(value)}, must be printable text of at most {LONGEST_TEXT} characters")
    return value


def _truth(name: str, value: Any) -> bool:
    if not isinstance(value, bool):
        raise ValueError(f"{name} is {shown(value)}, must be true or false")
    return value


def _number(name: str, value: Any) -> float | None:
    if value is None:
        return None
    if not isinstance(value, int | float) or isinstance(value, bool):
        raise ValueError(f"{name} is {shown(value)}, must be a number")
    return float(value)
