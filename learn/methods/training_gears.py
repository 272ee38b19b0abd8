"""Gears that are simulated to train on, gear by gear, in bounded memory."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from threadpoolctl import threadpool_limits
from tqdm import tqdm

from learn.inputs.reference_lines import QUARTERS, ReferenceLines
from learn.inputs.referenced import Referenced
from learn.inputs.rows import Rows, on_disk
from learn.methods.fault_outputs import FaultOutputs
from swgsim.common.compute import Engine
from swgsim.dataset.plan import Plan
from swgsim.dataset.simulate_cases import record


def training_gears(
    plan: Plan, outputs: FaultOutputs, engine: Engine, folder: Path
) -> tuple[Rows, Float[np.ndarray, "row 3"]]:
    """Inputs and targets of the samples of all gears of a plan.

    No recording is kept: inputs are in a temporary file in the folder, 1.2 MB for each gear of 288 samples in
    four directions, and they are the same for any number of processes.

    Parameters
    ----------
    plan : Plan
        With references, a bench and drawn variants.
    outputs : FaultOutputs
        Whose targets are made.
    engine : Engine
    folder : Path
    """
    targets = []

    def inputs() -> Iterator[Float[np.ndarray, "sample input"]]:
        tasks = ((replace(plan, gears=(gear,)), outputs) for gear in plan.gears)
        made = engine.results(gear_rows, tasks, len(plan.gears))
        for rows, of_rows in tqdm(made, "fast twin", len(plan.gears), unit=" gears"):
            targets.append(of_rows)
            yield rows

    return on_disk(inputs(), folder), np.concatenate(targets)


def gear_rows(
    plan: Plan, outputs: FaultOutputs
) -> tuple[Float[np.ndarray, "sample input"], Float[np.ndarray, "sample 3"]]:
    """Inputs and targets of the samples of the only gear of a plan, in every direction that it may have."""
    with threadpool_limits(1):
        made = Referenced("training").learning_set([record(plan, list(plan.grid.cases(*plan.gears)))])
        rows, targets = np.asarray(made.features), outputs.targets(made.table)
        inputs = ReferenceLines(plan.window, plan.grid.points)
        turns = [inputs(rows, quarters) for quarters in range(QUARTERS)]
        further = [targets + np.array([0, 0, quarters * 2 * np.pi / QUARTERS]) for quarters in range(QUARTERS)]
        return np.concatenate(turns).astype(np.float32), np.concatenate(further)
