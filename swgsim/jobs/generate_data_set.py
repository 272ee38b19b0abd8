"""The job of ``swg generate``: a data set from a configuration, unless it exists."""

import json
import re
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import joblib
from tqdm import tqdm

from swgsim.common.compute import Engine
from swgsim.common.files import sole_maker, write_json
from swgsim.dataset.dataset import disturb, generate, usage
from swgsim.dataset.plan import Plan, provenance
from swgsim.jobs import settings
from swgsim.storage import storage


def run(config: Mapping[str, Any]) -> dict[str, Any]:
    """Generate the data set ``<data>/<grid>-<condition>.h5``.

    The disturbed data set is made from the clean one of the same choices, which is generated first if it is missing. A
    data set of the same name from other choices or code is replaced.

    Returns
    -------
    dict
        path, recordings, seconds, recordings_per_second, peak_memory_mib, cores; also in a JSON file.
    """
    engine = Engine.of(config)
    path = Path(config["data"]) / f"{_name(config, 'grid')}-{_name(config, 'condition')}.h5"
    summary = path.with_suffix(".json")
    if is_current(path, settings.as_text(config)) and summary.exists():
        print(f"{path} is there already, made by the same choices and code")
        return dict(json.loads(summary.read_text()))
    plan = settings.plan(config)
    with sole_maker(path):
        result = _make(config, plan, path, engine)
        write_json(summary, result)
    print("{path}: {recordings} recordings in {seconds:.1f} s, peak memory {peak_memory_mib:.0f} MiB".format(**result))
    return result


def _make(config: Mapping[str, Any], plan: Plan, path: Path, engine: Engine) -> dict[str, Any]:
    """Make the data set; return its size, time and memory."""
    disturbance = settings.disturbance(config)
    if disturbance:
        clean = dict(config) | {"condition": {"name": "clean", "bench": None, "disturbance": None}}
        source = Path(run(clean)["path"])
    start = time.perf_counter()
    with tqdm(total=len(plan), desc=path.stem, unit=" recordings") as bar:
        if disturbance:
            disturb(source, path, disturbance, plan.configuration, bar.update)
            peak = usage().peak_memory_mib
        else:
            peak = generate(plan, path, engine, bar.update)
    seconds = time.perf_counter() - start
    return {
        "path": str(path),
        "recordings": len(plan),
        "seconds": round(seconds, 3),
        "recordings_per_second": round(len(plan) / seconds, 1),
        "peak_memory_mib": round(peak, 1),
        "cores": joblib.cpu_count(),
    }


def _name(config: Mapping[str, Any], group: str) -> str:
    """The name of the choice of a group, which is part of the file name."""
    name = config[group]["name"]
    if not (isinstance(name, str) and re.fullmatch(r"[\w.-]+", name)):
        raise ValueError(f"name of the {group} is {name!r}, must be of letters, digits, '_', '-' and '.' only")
    return name


def is_current(path: Path, configuration: str) -> bool:
    """Whether a file is undamaged and made by the same choices and code."""
    if not path.exists():
        return False
    try:
        storage.verify(path)
        found, now = storage.attributes(path), provenance(configuration)
    except ValueError as damage:
        print(damage)
        return False
    other = [what for key, what in (("configuration", "choices"), ("swgsim", "code")) if found.get(key) != now[key]]
    if other:
        print(f"{path} was made by other {' and '.join(other)} and is replaced")
    return not other
