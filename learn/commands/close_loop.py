"""The command ``swg close-loop``: the answer of a loop on gauges or on a robot joint, kept as a run in MLflow."""

import hashlib
import json
import logging
from collections.abc import Mapping
from typing import Any

from swgsim.common.outcome import Outcome
from swgsim.identification.report import close_loop as of_gauges
from swgsim.joint import close_joint_loop as of_joint

EXPERIMENT = "loop"
log = logging.getLogger(__name__)

# Choices that apply to recordings of a robot joint only, and to strain gauges only.
OF_JOINT: tuple[str, ...] = ("joint", "signal", "holdout", "without")
OF_GAUGES: tuple[str, ...] = ("commissioning", "mapping", "commissioning_mapping", "effects", "truth")


def require_one_kind(config: Mapping[str, Any]) -> None:
    """Raise a ValueError for a choice that applies to the other kind of recordings, where it would have no effect."""
    source = config["source"]
    if source is None:
        foreign, remedy = OF_JOINT, "is for robot joints: give source= as well"
    else:
        foreign, remedy = OF_GAUGES, f"is for strain gauges, source={source} for robot joints: leave one out"
    for name in foreign:
        if config[name] not in (None, []):
            raise ValueError(f"{name}= {remedy}")


def record(config: Mapping[str, Any], outcome: Outcome) -> None:
    """Keep the answer as an MLflow run; the answer is written already, so a run that cannot be kept is a warning."""
    from learn.tracking import StoreAway

    try:
        _record(config, outcome)
    except StoreAway as error:
        log.warning("the answer is in %s; its run could not be kept: %s", config["out"], error)


def _record(config: Mapping[str, Any], outcome: Outcome) -> None:
    import pandas as pd

    from learn import tracking
    from learn.jobs import settings

    report = outcome.report
    store = settings.store({**config["tracking"], "experiment": EXPERIMENT})
    of_kind = ("commissioning", "seed") if config["source"] is None else ("source", *OF_JOINT)
    chosen = {name: config[name] for name in ("recordings", *of_kind)}
    key = hashlib.sha256(json.dumps([config, outcome.digest], sort_keys=True).encode()).hexdigest()[:16]
    tags = {"data_digest": outcome.digest, "verdict": report["verdict"], "sentence": report["sentence"][:5000]}
    with tracking.job_run(store, report["verdict"], key, chosen, config, tags) as job:
        tables = {
            f"tables/{name}.parquet": pd.DataFrame(report[name]) for name in ("scores", "rungs") if name in report
        }
        job.record(
            metrics(report), {f"figures/{name}.png": each.png for name, each in outcome.pictures.items()}, tables
        )


def metrics(report: Mapping[str, Any]) -> dict[str, float]:
    """The figures of a report that are known: errors [%], sizes of the effects, seconds."""
    error = report["error"]
    found = {f"error_{when}_{what}": value for when in ("before", "after") for what, value in error[when].items()}
    found |= {"noise_floor": error["noise_floor"], "effects": len(report["effects"]), "seconds": report["seconds"]}
    for effect in report["effects"]:
        name = effect["name"].replace(":", ".")
        found |= {f"{name}/{key}": each["value"] for key, each in effect["parameters"].items()}
    return {name: float(value) for name, value in found.items() if value is not None}


def run(config: Mapping[str, Any]) -> None:
    """Close the loop on a folder of recordings and keep the answer as a run in MLflow."""
    require_one_kind(config)
    record(config, (of_gauges if config["source"] is None else of_joint).run(config))
