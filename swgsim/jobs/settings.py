"""From configuration to objects: mappings of conf/*.yaml become objects of this package."""

import hashlib
import inspect
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import yaml

from swgsim.bench.disturbance import Disturbance
from swgsim.bench.scatter import Bench
from swgsim.common.build import build
from swgsim.common.checks import require_known
from swgsim.dataset.faults import Variants
from swgsim.dataset.grid import Grid
from swgsim.dataset.plan import Plan
from swgsim.effects import text
from swgsim.effects.base import Effect
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.gear.gear import gear_from as gear
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
    "crack_teeth",
    "references",
    "scatter",
    "days",
    "seed",
    "population",
)

# Choices on which no recording depends.
WHEREABOUTS = ("data", "workers", "compute", "scheduler")

T = TypeVar("T")
Config = Mapping[str, Any]


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
    variants = Variants(config["variants"], config["positions"], severities, config["drawn"], config.get("crack_teeth"))
    numbers = {name: config[name] for name in ("references", "scatter", "seed", "days")}
    return Grid(points, variants, tuple(config["classes"]), **numbers)


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
