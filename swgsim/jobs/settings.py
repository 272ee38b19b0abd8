"""From configuration to objects: mappings of conf/*.yaml become objects of this package."""

import hashlib
import inspect
from collections.abc import Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

import yaml

from swgsim.bench.disturbance import Disturbance
from swgsim.bench.scatter import Bench
from swgsim.common.checks import require_known
from swgsim.dataset.faults import Variants
from swgsim.dataset.grid import Grid
from swgsim.dataset.plan import Plan
from swgsim.effects import text
from swgsim.effects.base import Effect
from swgsim.flexspline.gauges import GaugeSet
from swgsim.flexspline.silk_hat import SilkHat
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear, KinematicError, OperatingPoint, Transmission, WaveGenerator
from swgsim.gear.population import Population

# Keys of a file of conf/grid.
GRID = (
    "name",
    "speeds_rpm",
    "loads_nm",
    "classes",
    "variants",
    "positions",
    "severities",
    "drawn",
    "references",
    "scatter",
    "seed",
    "population",
)

# Choices on which no recording depends.
WHEREABOUTS = ("data", "workers", "compute", "scheduler")

T = TypeVar("T")
Config = Mapping[str, Any]


def build(kind: type[T], config: Config, **given: Any) -> T:
    """An object of a dataclass from a mapping; lists become tuples.

    Raises
    ------
    ValueError
        If the class does not know a key of the mapping; the message lists the choices.
    """
    require_known(kind.__name__, config, [f.name for f in fields(kind)])  # type: ignore[arg-type]
    values = {key: tuple(value) if isinstance(value, list) else value for key, value in config.items()}
    return kind(**(values | given))


def gear(config: Config) -> Gear:
    """A gear (conf/gear)."""
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


def grid(config: Config) -> Grid:
    """A grid (conf/grid)."""
    require_known("the grid", config, GRID)
    for name in ("speeds_rpm", "loads_nm", "classes"):
        if not isinstance(config[name], list):
            raise ValueError(f"{name} of the grid is {config[name]!r}, must be a list such as [{config[name]}]")
    points = tuple(OperatingPoint(n, T) for n in config["speeds_rpm"] for T in config["loads_nm"])
    for label, levels in config["severities"].items():
        if not isinstance(levels, list):
            raise ValueError(f"severities of {label} are {levels!r}, must be a list such as [{levels}]")
    severities = {label: tuple(levels) for label, levels in config["severities"].items()}
    variants = Variants(config["variants"], config["positions"], severities, config["drawn"])
    return Grid(
        points, variants, tuple(config["classes"]), config["references"], config["scatter"], seed=config["seed"]
    )


def gears(config: Config) -> tuple[Gear, ...]:
    """The gears of a configuration: those listed, or those drawn around the first one."""
    listed = tuple(gear(each) for each in config["gears"].values() if each)
    if not config["grid"]["population"]:
        return listed
    return build(Population, config["grid"]["population"]).draw(listed[0], config["grid"]["seed"])


def effects(config: Sequence[Any] | str) -> tuple[Effect, ...]:
    """Effects: a list of them, or the path of a file that holds one (conf/effect).

    Raises
    ------
    ValueError
        If the file is missing, or an effect or a parameter is unknown, missing or beyond its bounds.
    """
    if not isinstance(config, str):
        return text.from_entries(config)
    path = Path(config)
    if not path.is_file():
        raise ValueError(
            f"no file of effects {config!r}; give a list such as '[{text.EXAMPLE}]', or a file that holds one "
            "(conf/effect/example.yaml)"
        )
    return text.from_text(path.read_text(encoding="utf-8"), config)


def plan(config: Config) -> Plan:
    """The plan of a data set (conf/generate.yaml), without its disturbance."""
    bench = config["condition"]["bench"]
    return Plan(
        gears=gears(config),
        grid=grid(config["grid"]),
        window=build(Window, config["window"]),
        bench=build(Bench, bench) if bench else None,
        sectors=config["mesh"]["sectors"],
        effects=effects(config.get("effects", ())),
        configuration=as_text(config),
    )


def disturbance(config: Config) -> Disturbance | None:
    """The disturbance of eq. (10) of a condition, if it has one."""
    chosen = config["condition"]["disturbance"]
    return build(Disturbance, chosen) if chosen else None


def as_text(config: Config) -> str:
    """The choices on which recordings depend, as YAML: all except paths and processes.

    Effects are written in full, with a digest of code from outside this package; without effects the key is missing.
    """
    choices = {key: value for key, value in config.items() if key not in (*WHEREABOUTS, "effects")}
    declared = effects(config.get("effects", ()))
    if declared:
        choices |= {"effects": text.entries(declared), "code_of_effects": _foreign_code(declared)}
    return yaml.safe_dump(choices)


def _foreign_code(declared: Sequence[Effect]) -> dict[str, str]:
    """A digest of every module with an effect from outside this package, which its version does not include."""
    modules = {module for effect in declared if (module := inspect.getmodule(type(effect))) is not None}
    return {
        module.__name__: hashlib.sha256(inspect.getsource(module).encode()).hexdigest()[:12]
        for module in modules
        if not module.__name__.startswith("swgsim.")
    }
