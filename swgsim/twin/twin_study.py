"""The job of ``swg twin``: the twin of every gear of a data set judges its recordings and its units.

A unit is one specimen: a recording at every operating point, on one day or several. The oracle and the floor of
references (:mod:`swgsim.twin.floor`) judge the same, for comparison.
"""

import json
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float
from omegaconf import OmegaConf
from threadpoolctl import threadpool_limits

from swgsim.common.checks import require_integer
from swgsim.common.compute import Engine
from swgsim.common.seeds import generator
from swgsim.common.version import code_version
from swgsim.dataset.faults import Variant
from swgsim.dataset.plan import Plan
from swgsim.dataset.simulate_cases import record
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.identification.data.model import Model
from swgsim.jobs import settings
from swgsim.oracle.by_gear import GearByGear, chosen_gears, configuration_of, data_set, plan_of
from swgsim.oracle.cells import Partition, Resolution
from swgsim.oracle.diagnosis import diagnosis
from swgsim.oracle.model import bench_of, expectations, observations, partitions_of
from swgsim.oracle.oracle import known_gear_model
from swgsim.oracle.point import PointModel
from swgsim.oracle.severity import Severities
from swgsim.storage import storage
from swgsim.storage.labelled_signals import CLASSES, LabelledSignals
from swgsim.twin.fitted_gear import fit_gear
from swgsim.twin.floor import floor_of
from swgsim.twin.knowledge import Knowledge
from swgsim.twin.references import References
from swgsim.twin.twin import Twin

# Who judges recordings, and units with " unit" before the colon, as prefixes of the columns of probabilities. The twin
# of the session knows healthy specimens of it, the last oracle its biases.
WHO = (
    "", "unit:", "session:", "session unit:",
    "floor:", "floor unit:", "oracle:", "oracle unit:", "oracle known:", "oracle known unit:",
)  # fmt: skip

Densities = Callable[[Sequence[OperatingPoint], int], PointModel]  # at operating points, of the mean of some days

# What is known of every sample.
FACTS = ("gear", "label", "variant", "severity", "n_in_rpm", "T_out_nm")

# Choices of the configuration on which the result depends.
CHOICES = ("resolution", "believed", "further", "compared", "healthy")


def run(config: Mapping[str, Any]) -> dict[str, float]:
    """Write ``<data>/<grid>-<condition>-twin.parquet``, or ``<grid>-<condition>-twin-<case>.parquet``.

    Columns: ``row``, the number among the data set's samples; with ``true:``, :data:`FACTS` of the sample; the
    probability of every class by every one of :data:`WHO`; those of :data:`~swgsim.oracle.diagnosis.FOUND` for the
    recording and, with ``unit:``, for its unit; ``below`` and ``unit:below``, the posterior probability of a severity
    below the true one, given the true class; ``misfit`` of the references, and ``fit_seconds`` and ``seconds`` that the
    fit and the whole twin took, the same for all recordings of a gear.

    Returns
    -------
    dict
        Accuracy by everyone, and the number of samples.

    Raises
    ------
    ValueError
        If the data set is missing or made by other code, or lacks a chosen gear.
    """
    source = data_set(config)
    plan = plan_of(source)
    believed = settings.plan(_merged(configuration_of(source), config["believed"]))
    resolution = settings.build(Resolution, config["resolution"])
    nominal = settings.gear(next(iter(configuration_of(source)["gears"].values())))
    knowledge = Knowledge(replace(believed, gears=(nominal,)), resolution, tuple(config["further"]))
    made_from = {
        "data": storage.digest(source),
        "code": code_version("identification", "oracle", "twin"),
        "choices": json.dumps([config[each] for each in CHOICES], sort_keys=True),
    }
    require_integer("the twin", "healthy", config["healthy"], low=0, high=1000)
    if plan.grid.days > 1 and (config["compared"] or config["healthy"]):
        raise ValueError(
            f"{plan.grid.days} days of every specimen, and oracle and healthy specimens know one session: add "
            "compared=false healthy=0"
        )
    chosen = chosen_gears(plan, config["gears"])
    path = source.with_name("-".join([source.stem, "twin", *([config["case"]] if config["case"] else [])]) + ".parquet")
    found = GearByGear(plan, source, path, chosen, made_from).table(
        _judged,
        lambda gear, first, recordings: (
            knowledge,
            plan,
            gear,
            first,
            recordings,
            config["compared"],
            config["healthy"],
        ),
        Engine.of(config),
    )
    result: dict[str, float] = {"samples": len(found)}
    for who in [each for each in WHO if each + CLASSES[0] in found]:
        said = np.array(CLASSES)[found[[who + label for label in CLASSES]].to_numpy().argmax(axis=1)]
        name = who.strip(": ").replace(": ", "_").replace(":", "_").replace(" ", "_") or "twin"
        result[f"{name}_accuracy"] = float(np.mean(said == found["true:label"]))
        print(f"{path}, {name}: accuracy {result[f'{name}_accuracy']:.2%}")
    return result


def _merged(configuration: Mapping[str, Any], believed: Mapping[str, Any]) -> dict[str, Any]:
    """The choices of a data set, with those that the twin believes instead."""
    merged = OmegaConf.to_container(OmegaConf.merge(dict(configuration), dict(believed)))
    assert isinstance(merged, dict)
    return {str(key): value for key, value in merged.items()}


def _judged(
    knowledge: Knowledge, plan: Plan, gear: Gear, first: int, recordings: LabelledSignals, compared: bool, healthy: int
) -> pd.DataFrame:
    """What everyone says of one gear's samples."""
    with threadpool_limits(1):
        references, samples = References.of(recordings), recordings.samples
        began = time.perf_counter()
        fitted = fit_gear(knowledge, references)
        fit_seconds = time.perf_counter() - began
        twin = Twin.of(knowledge, fitted)
        seconds = time.perf_counter() - began
        tables = [_diagnosed(twin, samples, each).add_prefix(prefix) for each, prefix in ((False, ""), (True, "unit:"))]
        if healthy:
            of_session = twin.in_session(_further_healthy(plan, gear, healthy))
            tables += _probabilities("session", of_session.densities, plan, samples)
        tables += _compared(knowledge, plan, gear, references, samples) if compared else []
    table = pd.concat(tables, axis=1).assign(misfit=fitted.misfit, fit_seconds=fit_seconds, seconds=seconds)
    facts = samples.table[list(FACTS)].astype({"label": str}).add_prefix("true:").reset_index(drop=True)
    facts.insert(0, "row", np.arange(first, first + len(samples)))
    return pd.concat([facts, table], axis=1)


def _further_healthy(plan: Plan, gear: Gear, number: int) -> Float[np.ndarray, "specimen point feature"]:
    """Observations of healthy specimens of the first session that are not in the data set."""
    known = plan.grid.variants.count
    cases = [
        case
        for specimen in range(known, known + number)
        for case in plan.grid.of_specimen(gear, Variant("healthy", specimen, np.nan, np.nan, ()), specimen)
    ]
    return observations(record(plan, cases)).reshape(number, len(plan.grid.points), -1)


def _compared(
    knowledge: Knowledge, plan: Plan, gear: Gear, references: References, samples: LabelledSignals
) -> list[pd.DataFrame]:
    """Class probabilities by those who know the gear."""
    own = replace(knowledge, plan=replace(plan, gears=knowledge.plan.gears))
    expected = expectations(plan, gear, knowledge.resolution)
    unit = Model(*bench_of(plan).unit(gear, generator("unit", plan.grid.seed, gear.number)))
    floor = floor_of(own, unit, references, expected)
    tables = _probabilities("floor", floor.densities, plan, samples)
    for who, session_known in (("oracle", False), ("oracle known", True)):

        def densities(points: Sequence[OperatingPoint], days: int, known: bool = session_known) -> PointModel:
            there = [expected[plan.grid.points.index(point)] for point in points]
            return known_gear_model(plan, gear, there, known)

        tables += _probabilities(who, densities, plan, samples)
    return tables


def _observed(
    densities: Densities, plan: Plan, samples: LabelledSignals, of_units: bool
) -> Iterator[tuple[PointModel, Float[np.ndarray, "sample feature"], np.ndarray]]:
    """Densities, observations, and the rows (sample, recording) of the observations: by operating point, or of units.

    Recordings of a unit follow each other, day by day, one at every operating point, in the order of the plan.
    """
    x, grid = observations(samples), plan.grid
    points = grid.points
    if of_units:
        of_unit = x.reshape(-1, grid.days, len(points) * x.shape[1])
        rows = np.arange(len(x)).reshape(len(of_unit), -1)
        yield densities(points, grid.days), of_unit.mean(axis=1), rows
        return
    for point, here in zip(points, np.arange(len(x)).reshape(-1, len(points)).T, strict=True):
        yield densities([point], 1), x[here], here[:, None]


def _probabilities(who: str, densities: Densities, plan: Plan, samples: LabelledSignals) -> list[pd.DataFrame]:
    """Class probabilities of every recording, by itself and of its unit."""
    tables = []
    for prefix, of_units in ((f"{who}:", False), (f"{who} unit:", True)):
        found = np.empty((len(samples), len(CLASSES)))
        for model, x, rows in _observed(densities, plan, samples, of_units):
            found[rows] = np.exp(model.log_posterior(x))[:, None]
        tables.append(pd.DataFrame(found, columns=list(CLASSES)).add_prefix(prefix))
    return tables


def _diagnosed(twin: Twin, samples: LabelledSignals, of_units: bool) -> pd.DataFrame:
    """Diagnosis of every recording, by itself or of its unit, and the rank of its true severity."""
    parts = []
    partitions = partitions_of(twin.knowledge.plan, twin.knowledge.resolution)
    for model, x, rows in _observed(twin.densities, twin.knowledge.plan, samples, of_units):
        facts = samples.table.iloc[rows[:, 0]]
        found = diagnosis(model, partitions, x).assign(below=_below(model, partitions, x, facts))
        parts += [found.set_index(each) for each in rows.T]
    return pd.concat(parts).sort_index()


def _below(
    model: PointModel, partitions: Mapping[str, Partition], x: Float[np.ndarray, "sample feature"], facts: pd.DataFrame
) -> Float[np.ndarray, " sample"]:
    """Posterior probability of a severity below the true one, given the true class; NaN for healthy ones."""
    found = np.full(len(x), np.nan)
    label, severity = facts["label"].astype(str).to_numpy(), facts["severity"].to_numpy()
    for name, partition in partitions.items():
        rows = np.flatnonzero(label == name)
        if len(rows):
            found[rows] = Severities.of(partition, model.places(x[rows], name)).below(severity[rows])
    return found
