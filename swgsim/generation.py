"""The job of scripts/generate.py: a data set from a configuration, unless it is there already."""

import json
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import joblib
from tqdm import tqdm

from swgsim import settings, storage
from swgsim.dataset import disturb, generate, usage
from swgsim.files import write_json
from swgsim.plan import provenance


def run(config: Mapping[str, Any]) -> dict[str, Any]:
    """Generate the data set ``<data>/<grid>-<condition>.h5``.

    The disturbed one is made from the clean one of the same choices, which is generated first where it is missing.

    Returns
    -------
    dict
        path, recordings, seconds, recordings_per_second, peak_memory_mib, cores; also kept beside the data set as JSON.
    """
    name = f"{config['grid']['name']}-{config['condition']['name']}"
    path = Path(config["data"]) / f"{name}.h5"
    summary = path.with_suffix(".json")
    configuration = settings.as_text(config)
    if is_current(path, configuration) and summary.exists():
        print(f"{path} is there already, made by the same choices and code")
        return dict(json.loads(summary.read_text()))

    plan, disturbance = settings.plan(config), settings.disturbance(config)
    workers = config["workers"] or joblib.cpu_count()
    if disturbance:
        clean = dict(config) | {"condition": {"name": "clean", "bench": None, "disturbance": None}}
        source = Path(run(clean)["path"])
    start = time.perf_counter()
    with tqdm(total=len(plan), desc=name, unit=" recordings") as bar:
        if disturbance:
            disturb(source, path, disturbance, configuration, bar.update)
            peak = usage().peak_memory_mib
        else:
            peak = generate(plan, path, workers, bar.update)
    seconds = time.perf_counter() - start
    result = {
        "path": str(path),
        "recordings": len(plan),
        "seconds": round(seconds, 3),
        "recordings_per_second": round(len(plan) / seconds, 1),
        "peak_memory_mib": round(peak, 1),
        "cores": joblib.cpu_count(),
    }
    write_json(summary, result)
    print(f"{path}: {len(plan)} recordings in {seconds:.1f} s, peak memory {peak:.0f} MiB")
    return result


def is_current(path: Path, configuration: str) -> bool:
    """Whether a file is whole and made by the same choices and code."""
    if not path.exists():
        return False
    try:
        storage.verify(path)
    except ValueError as damage:
        print(damage)
        return False
    said = storage.attributes(path)
    return all(said.get(key) == value for key, value in provenance(configuration).items())
