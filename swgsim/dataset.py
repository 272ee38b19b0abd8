"""Data sets on disk: generated block by block, in parallel, resumable, the same bytes whatever happened on the way.

Every block is one part file, written aside and renamed. When all parts are there they are joined to one file. A run
that was killed finds the parts of the same configuration and goes on with the missing ones.
"""

import hashlib
import os
import resource
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import joblib
import numpy as np
from threadpoolctl import threadpool_limits

from swgsim import storage
from swgsim.acquisition import Window
from swgsim.bench import Bench
from swgsim.chain import SECTORS, Simulation, simulate
from swgsim.disturbance import Disturbance
from swgsim.gear import Gear
from swgsim.grid import Case, Grid
from swgsim.recordings import COLUMNS, Recordings, facts
from swgsim.seeds import generator
from swgsim.version import code_version

# Recordings per block: bounds the memory whatever the size of the grid, and splits the paper's grid evenly over cores.
BLOCK = 1140


@dataclass(frozen=True)
class Plan:
    """All that determines the recordings of a data set.

    Attributes
    ----------
    gears : tuple of Gear
    grid : Grid
    window : Window
    bench : Bench or None
        The imperfections of a real test bench, if any.
    sectors : int
        Sectors of the flex spline's truss.
    configuration : str
        The choices as text; kept in the file.
    """

    gears: tuple[Gear, ...]
    grid: Grid
    window: Window
    bench: Bench | None = None
    sectors: int = SECTORS
    configuration: str = ""

    def __post_init__(self) -> None:
        numbers = [gear.number for gear in self.gears]
        if not numbers:
            raise ValueError("no gears: the grid is empty, choose at least one")
        if len(set(numbers)) < len(numbers):
            raise ValueError(f"gear numbers {numbers} are not distinct: every gear needs a number of its own")

    def __len__(self) -> int:
        return len(self.gears) * self.grid.count()

    @property
    def attributes(self) -> dict[str, str]:
        """What the file says of itself; parts of a killed run are used only where it is the same."""
        return provenance(self.configuration)

    @property
    def blocks(self) -> list[tuple[int, int]]:
        """(gear, first case) of every block."""
        return [(g, first) for g in range(len(self.gears)) for first in range(0, self.grid.count(), BLOCK)]

    def cases(self, block: tuple[int, int]) -> list[Case]:
        """The planned recordings of a block."""
        gear, first = block
        return list(islice(self.grid.cases(self.gears[gear]), first, first + BLOCK))


def provenance(configuration: str) -> dict[str, str]:
    """Configuration and version of the code, as attributes of a file."""
    return {"configuration": configuration, "swgsim": code_version()}


@dataclass(frozen=True)
class Usage:
    """Memory that a process has needed so far."""

    process: int
    peak_memory_mib: float


def usage() -> Usage:
    """That of this process."""
    return Usage(os.getpid(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)


def generate(plan: Plan, path: Path, workers: int, progress: Callable[[int], object]) -> float:
    """Generate a data set.

    Parameters
    ----------
    plan : Plan
    path : Path
        The file to make.
    workers : int
        Processes to use; the file is the same for any number.
    progress : callable
        Called with the number of recordings whenever that many more are done.

    Returns
    -------
    float
        Peak memory of all processes together [MiB].
    """
    same = hashlib.sha256("".join(plan.attributes.values()).encode()).hexdigest()[:12]
    parts = path.with_name(f".{path.name}.{same}.parts")
    parts.mkdir(parents=True, exist_ok=True)
    files = [parts / f"{number:06d}.npz" for number in range(len(plan.blocks))]
    todo = [i for i, file in enumerate(files) if not file.exists()]
    progress(len(plan) - sum(len(plan.cases(plan.blocks[i])) for i in todo))
    jobs = (joblib.delayed(_make_part)(plan, plan.blocks[i], files[i]) for i in todo)
    peak: dict[int, float] = {}
    for done, used in joblib.Parallel(n_jobs=min(workers, max(len(todo), 1)), return_as="generator_unordered")(jobs):
        peak[used.process] = max(used.peak_memory_mib, peak.get(used.process, 0))
        progress(done)
    storage.write(path, (_read_part(file, plan) for file in files), len(plan))
    shutil.rmtree(parts)
    peak[os.getpid()] = usage().peak_memory_mib
    return sum(peak.values())


def disturb(source: Path, path: Path, disturbance: Disturbance, configuration: str, progress: Callable) -> None:
    """Make the disturbed data set from the clean one: its recordings plus eq. (10).

    Parameters
    ----------
    source, path : Path
        The clean file and the one to make.
    """

    def disturbed() -> Iterator[Recordings]:
        for block in storage.blocks(source, BLOCK):
            time = np.arange(block.signals.shape[2]) / block.rate
            added = np.stack([
                disturbance.draw(generator("disturbance", seed), block.signals.shape[1], n_in_rpm, time)
                for seed, n_in_rpm in zip(block.table["seed"], block.table["n_in_rpm"], strict=True)
            ])  # fmt: skip
            signals = (block.signals + added).astype("f4")
            yield Recordings(signals, block.table, block.rate, provenance(configuration))
            progress(len(block))

    storage.write(path, disturbed(), storage.count(source))


def _make_part(plan: Plan, block: tuple[int, int], file: Path) -> tuple[int, Usage]:
    """Simulate one block and keep it; one thread, so that the bytes do not depend on the number of cores."""
    with threadpool_limits(1):
        recordings = record(plan, plan.cases(block))
    aside = file.with_name(f".{file.name}.{os.getpid()}.tmp")
    with aside.open("wb") as raw:
        columns = {name: recordings.table[name].to_numpy() for name in COLUMNS}
        columns["label"] = columns["label"].astype("U")
        np.savez(raw, allow_pickle=False, signals=recordings.signals, **columns)
    os.replace(aside, file)
    return len(recordings), usage()


def _read_part(file: Path, plan: Plan) -> Recordings:
    with np.load(file, allow_pickle=False) as part:
        table = facts({name: part[name] for name in COLUMNS})
        return Recordings(part["signals"], table, plan.window.rate, plan.attributes)


def record(plan: Plan, cases: list[Case]) -> Recordings:
    """The recordings of some cases of a plan."""
    runs = [case.run for case in cases]
    temperature = np.full(len(cases), np.nan)
    if plan.bench:
        gears = list(dict.fromkeys(run.gear for run in runs))
        units = {gear: plan.bench.unit(gear, generator("unit", plan.grid.seed, gear.number)) for gear in gears}
        for i, case in enumerate(cases):
            gear, imperfections = units[case.run.gear]
            planned = type(case.run)(gear, case.run.point, (*imperfections, *case.run.effects))
            runs[i], temperature[i] = plan.bench.run(planned, generator("bench run", case.seed))
    simulation = simulate(runs, plan.window, plan.sectors)
    signals, efficiency = _acquire(plan, cases, simulation)
    variants = [case.variant for case in cases]
    table = facts({
        "gear": [case.run.gear.number for case in cases],
        "label": [variant.label for variant in variants],
        "variant": [variant.number for variant in variants],
        "severity": [variant.severity for variant in variants],
        "position": [variant.position for variant in variants],
        "n_in_rpm": [case.run.point.n_in_rpm for case in cases],
        "T_out_nm": [case.run.point.T_out for case in cases],
        "efficiency": efficiency,
        "temperature_c": temperature,
        "reference": [case.reference for case in cases],
        "seed": np.array([case.seed for case in cases], dtype="u8"),
    })  # fmt: skip
    return Recordings(signals, table, plan.window.rate, plan.attributes)


def _acquire(plan: Plan, cases: list[Case], simulation: Simulation) -> tuple[np.ndarray, np.ndarray]:
    """Signals (float32) and efficiency as the acquisition delivers them."""
    signals = np.empty(simulation.signals.shape, "f4")
    efficiency = simulation.efficiency.copy()
    T_in, T_out = simulation.motion.T_in.mean(axis=1), simulation.motion.T_out.mean(axis=1)
    for i, (case, ideal, motion) in enumerate(zip(cases, simulation.signals, simulation.of_run, strict=True)):
        rng = generator("acquisition", case.seed)
        if plan.bench:
            ideal = plan.bench.signals(ideal, rng)
            efficiency[i] = plan.bench.efficiency(efficiency[i], T_in[motion], T_out[motion], rng)
        signals[i] = plan.window.acquire(ideal, rng)
    return signals, efficiency
