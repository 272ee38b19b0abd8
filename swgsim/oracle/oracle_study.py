"""The job of ``swg oracle``: class probabilities of the oracle for a data set, unless they exist."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

from swgsim.common.compute import Engine
from swgsim.common.version import code_version
from swgsim.dataset.plan import Plan
from swgsim.gear.gear import Gear
from swgsim.jobs import settings
from swgsim.oracle.by_gear import GearByGear, chosen_gears, data_set, plan_of
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
    source = data_set(config)
    plan = plan_of(source)
    chosen = chosen_gears(plan, config["gears"])
    resolution = settings.build(Resolution, config["resolution"])
    made_from = {
        "data": storage.digest(source),
        "code": code_version("oracle"),
        "resolution": json.dumps(config["resolution"], sort_keys=True),
    }
    path = source.with_name(f"{source.stem}-oracle.parquet")
    found = GearByGear(plan, source, path, chosen, made_from).table(
        _judged, lambda gear, first, recordings: (plan, gear, resolution, first, recordings.samples), Engine.of(config)
    )
    result = _score(found, plan, chosen)
    for whom, before in (("session unknown", ""), ("session known", "known_")):
        accuracy, confidence = result[f"{before}accuracy"], result[f"{before}confidence"]
        print(f"{path}, {whom}: accuracy {accuracy:.2%}, mean confidence {confidence:.2%}")
    return result


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
