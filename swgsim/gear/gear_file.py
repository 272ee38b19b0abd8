"""Gears in YAML files (conf/gear)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from omegaconf import OmegaConf

from swgsim.common.build import build
from swgsim.common.plain_yaml import plain
from swgsim.flexspline.gauges import GaugeSet
from swgsim.flexspline.silk_hat import SilkHat
from swgsim.gear.gear import Gear, KinematicError, Transmission, WaveGenerator


def gear_from(config: Mapping[str, Any]) -> Gear:
    """A gear from a mapping; a part or parameter that is missing keeps the value of the paper's first gear.

    Raises
    ------
    ValueError
        If a parameter is unknown or beyond its limits.
    """
    transmission = dict(config.get("transmission", {}))
    if "kinematic_error" in transmission:
        transmission["kinematic_error"] = [build(KinematicError, term) for term in transmission["kinematic_error"]]
    parts = {
        "transmission": build(Transmission, transmission),
        "flex_spline": build(SilkHat, config.get("flex_spline", {})),
        "wave_generator": build(WaveGenerator, config.get("wave_generator", {})),
        "gauges": build(GaugeSet, config.get("gauges", {})),
    }
    return build(Gear, {key: value for key, value in config.items() if key not in parts}, **parts)


def load_gear(path: str | Path) -> Gear:
    """Read a gear from a YAML file such as those of conf/gear; numbers are in SI units.

    Raises
    ------
    ValueError
        If the file is missing, holds no mapping, or a parameter is unknown or beyond its limits.
    """
    path = Path(path)
    if not path.is_file():
        raise ValueError(f"no gear file {path}: copy conf/gear/gear1.yaml and change its numbers")
    try:
        return gear_from(_values(path))
    except ValueError as error:
        raise ValueError(f"gear file {path}: {error}") from error


def _values(path: Path) -> dict[str, Any]:
    """The numbers of a file on top of those of the files that it names under ``defaults``, as Hydra composes them."""
    config = plain(path.read_text(encoding="utf-8"))
    if not isinstance(config, dict):
        raise ValueError(f"holds {type(config).__name__}, expected names with values")
    bases = [name for name in config.pop("defaults", []) if name != "_self_"]
    merged = OmegaConf.merge(*(_values(path.with_name(f"{name}.yaml")) for name in bases), config)
    return dict(OmegaConf.to_container(merged))  # type: ignore[arg-type]
