"""Expected observations of a gear: healthy runs with the scatter of the bench, and the changes by every fault.

An observation has the order lines 0 to ORDERS of the five gauges [mV/V], real parts first, then imaginary parts. The
logarithm of the efficiency and the recorded temperature [degC] follow.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import chain, product

import numpy as np
from jaxtyping import Complex, Float

from swgsim.bench.scatter import Bench
from swgsim.chain.chain import Run
from swgsim.common.seeds import generator, seed_hash
from swgsim.dataset.faults import FAULTS, Variant
from swgsim.dataset.grid import Case
from swgsim.dataset.plan import Plan
from swgsim.dataset.simulate_cases import record
from swgsim.effects import Effect, ParameterScatter
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.oracle.cells import Cells, Partition, Resolution
from swgsim.storage.labelled_signals import LabelledSignals
from swgsim.storage.orders import lines_of

# Highest order of an observation.
ORDERS = 12

# Errors of the bench that are added to a recording after the chain, and errors that change the run itself.
ADDED = (
    "noise",
    "zero_drift",
    "flange_in",
    "flange_out",
    "flange_in_bias",
    "flange_out_bias",
    "temperature_error",
    "speed_reading",
)
MOVING = ("load", "speed", "index_angle", "output_angle", "temperature")

SOUND = Variant("healthy", 0, np.nan, np.nan, ())


@dataclass(frozen=True)
class Expectation:
    """Observations of one gear at one operating point without added errors.

    Attributes
    ----------
    point : OperatingPoint
    healthy : array (draw, feature)
        Observations of healthy runs with the scatter of the bench.
    faults : mapping
        Cells of each fault class.
    """

    point: OperatingPoint
    healthy: Float[np.ndarray, "draw feature"]
    faults: Mapping[str, Cells]


def bench_of(plan: Plan) -> Bench:
    """The bench of a plan.

    Raises
    ------
    ValueError
        If it has none.
    """
    if plan.bench is None:
        raise ValueError("the oracle needs the statistics of a bench and the plan has none: choose condition=bench")
    return plan.bench


def expectations(plan: Plan, gear: Gear, resolution: Resolution) -> list[Expectation]:
    """Expected observations of a gear at every operating point of the plan.

    Raises
    ------
    ValueError
        If the plan has no bench, no healthy class, or fault variants that are not drawn.
    """
    healthy = healthy_runs(plan, gear, resolution.draws)
    partitions = partitions_of(plan, resolution)
    variants = {label: partition.variants() for label, partition in partitions.items()}
    still = _with_bench(plan, replace(bench_of(plan), **dict.fromkeys(ADDED + MOVING, 0.0)))
    # All at once, as shared motions and structures are computed once.
    found = _observed(still, gear, [SOUND, *chain.from_iterable(variants.values())])
    ends = np.cumsum([len(each) for each in variants.values()], dtype=int)
    pieces = np.split(found[:, 1:] - found[:, :1], ends, axis=1)  # and an empty one after the last end
    changes = dict(zip(variants, pieces, strict=False))
    return [
        Expectation(point, healthy[i], {label: each.cells(changes[label][i]) for label, each in partitions.items()})
        for i, point in enumerate(plan.grid.points)
    ]


def healthy_runs(plan: Plan, gear: Gear, draws: int) -> Float[np.ndarray, "point draw feature"]:
    """Observations of healthy runs at every operating point, with the scatter of the bench and without added errors.

    Raises
    ------
    ValueError
        If the plan has no bench.
    """
    varying = _with_bench(plan, replace(bench_of(plan), **dict.fromkeys(ADDED, 0.0)))
    return _observed(varying, gear, [replace(SOUND, number=number) for number in range(draws)], plan.grid.scatter)


def partitions_of(plan: Plan, resolution: Resolution) -> dict[str, Partition]:
    """The cells of each fault class of a plan.

    Raises
    ------
    ValueError
        If the plan has no healthy class, or fault variants that are not drawn.
    """
    if "healthy" not in plan.grid.classes:
        raise ValueError(f"no 'healthy' among the classes {plan.grid.classes}, to which the oracle compares: add it")
    if not plan.grid.variants.drawn:
        raise ValueError(
            "the fault variants of this grid are a list (drawn is false), while the oracle spreads each class evenly "
            "between its extremes: choose a grid whose variants are drawn, such as grid=sampled"
        )
    return {
        label: Partition.of(label, plan.grid.variants.severities[label], resolution, plan.sectors)
        for label in FAULTS
        if label in plan.grid.classes
    }


def observations(recordings: LabelledSignals) -> Float[np.ndarray, "sample feature"]:
    """Observations of recordings.

    Raises
    ------
    ValueError
        If an efficiency is not above 0.
    """
    table = recordings.table
    efficiency = table["efficiency"].to_numpy()
    if not (efficiency > 0).all():
        raise ValueError(f"efficiency {efficiency.min():g} found, the oracle takes its logarithm: leave out low loads")
    return observed(lines_of(recordings, ORDERS), efficiency, table["temperature_c"].to_numpy())


def observed(
    lines: Complex[np.ndarray, "sample sensor order"],
    efficiency: Float[np.ndarray, " sample"],
    temperature: Float[np.ndarray, " sample"],
) -> Float[np.ndarray, "sample feature"]:
    """Observations of order lines 0 to ORDERS [mV/V], efficiency and temperature [degC]."""
    parts = (lines.real.reshape(len(lines), -1), lines.imag[:, :, 1:].reshape(len(lines), -1))
    return np.column_stack([*parts, np.log(efficiency), temperature])


def _with_bench(plan: Plan, bench: Bench) -> Plan:
    """The plan on another bench, without noise and quantisation of the window."""
    return replace(plan, bench=bench, window=replace(plan.window, noise=0.0, quantum=0.0))


def _observed(
    plan: Plan, gear: Gear, variants: Iterable[Variant], scatter: float = 0.0
) -> Float[np.ndarray, "point variant feature"]:
    """Observations of simulated recordings of a gear, with other random draws than those of the data set."""
    cases = []
    for point, variant in product(plan.grid.points, variants):
        seed = seed_hash("oracle", plan.grid.seed, gear.number, variant.number, point.n_in_rpm, point.T_out)
        effects: tuple[Effect, ...] = variant.effects
        if scatter:
            b1_ratio, k1_ratio = np.clip(generator("scatter", seed).normal(1, scatter, 2), 0.8, 1.2)
            effects = (*effects, ParameterScatter(float(b1_ratio), float(k1_ratio)))
        cases.append(Case(Run(gear, point, effects), variant, False, seed))
    found = observations(record(plan, cases))
    return found.reshape(len(plan.grid.points), -1, found.shape[1])
