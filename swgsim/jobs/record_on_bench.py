"""The job of ``swg record``: a unit of a gear on the virtual test bench, as a folder of recordings and its truth."""

import hashlib
import time
from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import yaml
from tqdm import tqdm

from swgsim.bench.scatter import Bench
from swgsim.bench.truth import require_new, truth_of, write_sealed
from swgsim.bench.virtual_bench import Instruments, Sessions, record_sessions
from swgsim.common.version import code_version
from swgsim.effects import text
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.gear.population import Population
from swgsim.jobs import settings


def run(config: Mapping[str, Any]) -> dict[str, Any]:
    """Record the folder ``out`` (docs/virtual_bench.md).

    Beside the recordings it holds what may be known of the gear: ``gear.yaml``, the nominal one, and ``effects.yaml``,
    the declared effects. Hidden effects, the unit and the seeds are in ``<out>.truth.json`` only, which is sealed.

    Returns
    -------
    dict
        path, truth, recordings and seconds.

    Raises
    ------
    ValueError
        If the folder or its truth is there already, or a choice is unknown or beyond its limits.
    """
    folder = Path(config["out"])
    require_new(folder)
    nominal = settings.gear(config["gear"])
    unit = _unit(nominal, config)
    declared, hidden = settings.effects(config["effects"]), settings.effects(config["hidden"])
    plan = _sessions(config)
    start = time.perf_counter()
    with tqdm(total=len(plan), desc=folder.name, unit=" recordings") as bar:
        recordings = record_sessions(
            unit,
            (*declared, *hidden),
            plan,
            _bench(config),
            seed=config["seed"],
            window=settings.build(Window, config["sampling"]),
            sectors=config["mesh"]["sectors"],
            name=str(config["name"]),
            instruments=settings.build(Instruments, config["instruments"]),
            progress=bar.update,
        )
    recordings = tuple(replace(each, label=str(config["label"])) for each in recordings)
    known = {
        "gear.yaml": yaml.safe_dump(config["gear"], sort_keys=False),
        "effects.yaml": text.as_text(declared),
    }
    choices = {key: value for key, value in config.items() if key != "out"}
    truth = {
        "salt": hashlib.sha256(f"salt of {choices}".encode()).hexdigest(),
        "hidden": text.entries(hidden),
        "declared": text.entries(declared),
        "unit": asdict(unit),
        "choices": choices,
        "swgsim": code_version(),
    }
    write_sealed(folder, recordings, known, truth)
    seconds = round(time.perf_counter() - start, 3)
    print(f"{folder}: {len(recordings)} recordings in {seconds:.1f} s; its truth is in {truth_of(folder)}")
    return {
        "path": str(folder),
        "truth": str(truth_of(folder)),
        "recordings": len(recordings),
        "seconds": seconds,
    }


def _unit(nominal: Gear, config: Mapping[str, Any]) -> Gear:
    """One physical gear of the series, the same for the same unit number."""
    series = settings.build(Population, config["spread"], count=1)
    return replace(series.draw(nominal, config["unit"])[0], number=nominal.number)


def _sessions(config: Mapping[str, Any]) -> Sessions:
    """What is to be recorded."""
    for name in ("speeds_rpm", "loads_nm"):
        if not isinstance(config[name], list):
            raise ValueError(f"{name} is {config[name]!r}, must be a list such as [{config[name]}]")
    points = tuple(OperatingPoint(float(n), float(T)) for n in config["speeds_rpm"] for T in config["loads_nm"])
    return settings.build(Sessions, config["sessions"], points=points)


def _bench(config: Mapping[str, Any]) -> Bench:
    """The errors of the bench."""
    condition = config["condition"]
    if not condition["bench"]:
        raise ValueError(
            f"condition {condition['name']} has no bench, whose errors every recording carries: choose condition=bench"
        )
    return settings.build(Bench, condition["bench"])
