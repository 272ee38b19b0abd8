"""The job of ``swg oracle``: class probabilities of the oracle for a data set, unless they exist."""

import json
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml
from threadpoolctl import threadpool_limits
from tqdm import tqdm

from swgsim.common.compute import Engine
from swgsim.common.files import replacing, sole_maker
from swgsim.common.version import code_version
from swgsim.dataset.plan import Plan
from swgsim.gear.gear import Gear
from swgsim.jobs import settings
from swgsim.oracle.cells import Resolution
from swgsim.oracle.columns import KNOWN
from swgsim.oracle.model import expectations
from swgsim.oracle.oracle import judge
from swgsim.storage import storage
from swgsim.storage.labelled_signals import CLASSES, LabelledSignals


def run(config: Mapping[str, Any]) -> dict[str, float]:
    """Write ``<data>/<grid>-<condition>-oracle.parquet``.

    Columns: ``row``, the number among the data set's samples (all but the references, in the order of the file); the
    posterior probability of every class; and the same with the prefix ``known:`` for an oracle that also knows the
    flange bias of the session.

    Returns
    -------
    dict
        accuracy and mean confidence, of both oracles, and the number of samples.

    Raises
    ------
    ValueError
        If the data set is missing or made by other code, or lacks a chosen gear.
    """
    source = Path(config["data"]) / f"{config['grid']['name']}-{config['condition']['name']}.h5"
    plan = _plan(source)
    chosen = _chosen(plan, config["gears"])
    resolution = settings.build(Resolution, config["resolution"])
    made_from = {
        "data": storage.digest(source),
        "code": code_version("oracle"),
        "resolution": json.dumps(config["resolution"], sort_keys=True),
    }
    path = source.with_name(f"{source.stem}-oracle.parquet")
    attributes = {**made_from, "gears": chosen}
    found = _kept(path, attributes)
    if found is not None:
        print(f"{path} is there already, for the same data set, gears, resolution and code")
    else:
        with sole_maker(path):
            found = _make(plan, source, chosen, resolution, made_from, path, Engine.of(config))
            _keep(path, found, attributes)
            shutil.rmtree(_parts(path))
    result = _score(found, plan, chosen)
    for whom, before in (("session unknown", ""), ("session known", "known_")):
        accuracy, confidence = result[f"{before}accuracy"], result[f"{before}confidence"]
        print(f"{path}, {whom}: accuracy {accuracy:.2%}, mean confidence {confidence:.2%}")
    return result


def _plan(source: Path) -> Plan:
    """The plan of a data set, from its attributes."""
    if not source.is_file():
        grid, condition = source.stem.rsplit("-", 1)
        raise ValueError(f"no data set {source}; make it with 'swg generate grid={grid} condition={condition}'")
    found = storage.attributes(source)
    if found["swgsim"] != code_version():
        raise ValueError(
            f"{source} was made by code {found['swgsim']}, while this is {code_version()}, whose gears may differ: "
            "make the data set again with swg generate"
        )
    return settings.plan(yaml.safe_load(found["configuration"]))


def _chosen(plan: Plan, gears: list[int] | None) -> list[int]:
    """Numbers of the gears to judge, in the order of the file."""
    there = [gear.number for gear in plan.gears]
    missing = set(gears or []) - set(there)
    if missing or gears == []:
        raise ValueError(f"gears is {gears}, the data set has {there}: choose some of them, or null for all")
    return [number for number in there if gears is None or number in gears]


def _make(
    plan: Plan,
    source: Path,
    chosen: list[int],
    resolution: Resolution,
    made_from: Mapping[str, Any],
    path: Path,
    engine: Engine,
) -> pd.DataFrame:
    """Judge the gears one by one; each is a part from which a killed run resumes."""
    files = {number: _parts(path) / f"{number:06d}.parquet" for number in chosen}
    parts = {number: part for number, file in files.items() if (part := _kept(file, made_from)) is not None}
    left = [number for number in chosen if number not in parts]
    tasks = (
        (plan, gear, resolution, first, samples)
        for gear, first, samples in _samples(plan, source)
        if gear.number in left
    )
    with tqdm(total=len(chosen), initial=len(parts), desc=path.stem, unit=" gears") as bar:
        for number, part in zip(left, engine.results(_judged, tasks, len(left)), strict=True):
            _keep(files[number], part, made_from)
            parts[number] = part
            bar.update()
    return pd.concat([parts[number] for number in chosen], ignore_index=True)


def _samples(plan: Plan, source: Path) -> Iterator[tuple[Gear, int, LabelledSignals]]:
    """Every gear with the number of its first sample and its samples."""
    first = 0
    for gear, block in zip(plan.gears, storage.blocks(source, plan.grid.count()), strict=True):
        samples = block.samples
        yield gear, first, samples
        first += len(samples)


def _judged(plan: Plan, gear: Gear, resolution: Resolution, first: int, samples: LabelledSignals) -> pd.DataFrame:
    """Class probabilities of both oracles for one gear's samples."""
    with threadpool_limits(1):
        expected = expectations(plan, gear, resolution)
        both = np.hstack([judge(plan, gear, expected, samples, session_known) for session_known in (False, True)])
    table = pd.DataFrame(both, columns=[*CLASSES, *(KNOWN + label for label in CLASSES)])
    table.insert(0, "row", np.arange(first, first + len(samples)))
    return table


def _score(found: pd.DataFrame, plan: Plan, chosen: list[int]) -> dict[str, float]:
    """Accuracy and mean confidence of both oracles."""
    gears = [gear for gear in plan.gears if gear.number in chosen]
    truth = [case.variant.label for gear in gears for case in plan.grid.cases(gear) if not case.reference]
    result: dict[str, float] = {"samples": len(found)}
    for name, before in (("", ""), ("known_", KNOWN)):
        p = found[[before + label for label in CLASSES]].to_numpy()
        result[f"{name}accuracy"] = float(np.mean(np.array(CLASSES)[p.argmax(axis=1)] == truth))
        result[f"{name}confidence"] = float(p.max(axis=1).mean())
    return result


def _parts(path: Path) -> Path:
    """Folder of the parts of a file."""
    return path.with_name(f".{path.name}.parts")


def _keep(path: Path, table: pd.DataFrame, attributes: Mapping[str, Any]) -> None:
    """Write a table with its attributes; the file is complete or absent."""
    table.attrs = {name: value for name, value in attributes.items()}  # pandas keeps them in the file
    with replacing(path) as aside:
        table.to_parquet(aside, engine="pyarrow", index=False)


def _kept(path: Path, attributes: Mapping[str, Any]) -> pd.DataFrame | None:
    """The table of a file, if it exists and has the same attributes."""
    if not path.exists():
        return None
    try:
        table = pd.read_parquet(path, engine="pyarrow")
    except (OSError, ValueError) as damage:
        print(f"{path}: damaged, made again ({damage})")
        return None
    return table if table.attrs == attributes else None
