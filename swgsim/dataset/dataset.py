"""Data sets on disk, generated block by block and in parallel; interrupted runs resume and give the same bytes.

Each block is one part: a file of recordings like the data set. Complete parts are joined to one file. After a killed
run the next one keeps the valid parts of the same plan and makes the others.
"""

import os
import resource
import shutil
import socket
from collections.abc import Callable, Generator, Iterator
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from swgsim.bench.disturbance import Disturbance
from swgsim.common.compute import Engine
from swgsim.common.files import sole_maker
from swgsim.common.seeds import generator
from swgsim.dataset.grid import Case
from swgsim.dataset.plan import Plan, block_size, provenance
from swgsim.dataset.simulate_cases import record
from swgsim.storage import storage
from swgsim.storage.labelled_signals import LabelledSignals


@dataclass(frozen=True)
class Usage:
    """Peak memory of a process."""

    process: str
    peak_memory_mib: float


@dataclass(frozen=True)
class Part:
    """A complete part.

    Attributes
    ----------
    rows : int
        Number of recordings.
    flaw : str
        Reason why the part of a killed run was made again; empty if it was not.
    usage : Usage
    """

    rows: int
    flaw: str
    usage: Usage


def usage() -> Usage:
    """Peak memory of this process."""
    return Usage(f"{socket.gethostname()} {os.getpid()}", resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)


def generate(plan: Plan, path: Path, engine: Engine, progress: Callable[[int], object]) -> float:
    """Generate a data set.

    Parameters
    ----------
    plan : Plan
    path : Path
        The file to make.
    engine : Engine
        Processes that make the blocks; the file is the same for any. Workers need access to the folder of ``path``.
    progress : callable
        Called with the number of recordings that were finished since the last call.

    Returns
    -------
    float
        Peak memory of all processes together [MiB].
    """
    parts = path.absolute().with_name(f".{path.name}.parts")  # workers may have begun in another folder
    files = [parts / f"{number:06d}.h5" for number in range(plan.block_count)]
    tasks = ((plan, cases, file) for cases, file in zip(plan.blocks(), files, strict=True))
    peak: dict[str, float] = {}

    def made() -> Generator[LabelledSignals, None, None]:
        """The parts in order; they are joined while the workers make the next ones."""
        for part, file in zip(engine.results(_part, tasks, len(files)), files, strict=True):
            if part.flaw:
                print(f"{part.flaw}; it has been made again")
            peak[part.usage.process] = max(part.usage.peak_memory_mib, peak.get(part.usage.process, 0))
            progress(part.rows)
            yield _read(plan, file)

    try:
        with closing(made()) as blocks:
            storage.write(path, blocks, len(plan))
    except BaseException:
        # Workers of this machine may have ended while writing; those of a cluster finish their parts.
        for left in parts.glob(".*.tmp") if engine.scheduler is None else ():
            left.unlink(missing_ok=True)
        raise
    shutil.rmtree(parts, ignore_errors=True)  # a worker of a killed run may still write its last part
    own = usage()
    peak[own.process] = own.peak_memory_mib
    return sum(peak.values())


def disturb(source: Path, path: Path, disturbance: Disturbance, configuration: str, progress: Callable) -> None:
    """Make the disturbed data set from the clean one: its recordings plus the disturbance of eq. (10).

    Eq. (10) is :meth:`swgsim.bench.disturbance.Disturbance.draw`.

    Parameters
    ----------
    source, path : Path
        The clean file and the one to make.
    disturbance : Disturbance
        Amplitudes a_j [mV/V] of eq. (10); drawn for every recording from its seed.
    configuration : str
        Configuration that is written to the file.
    progress : callable
        Called with the number of recordings that were finished since the last call.
    """
    rows, _, samples = storage.shape(source)

    def made() -> Iterator[LabelledSignals]:
        for block in storage.blocks(source, block_size(samples)):
            yield replace(disturbed(block, disturbance), attributes=provenance(configuration))
            progress(len(block))

    storage.write(path, made(), rows)


def disturbed(recordings: LabelledSignals, disturbance: Disturbance) -> LabelledSignals:
    """Recordings plus the disturbance of eq. (10), drawn for each from its seed."""
    _, sensors, samples = recordings.signals.shape
    time = np.arange(samples) / recordings.rate
    facts = zip(recordings.table["seed"], recordings.table["n_in_rpm"], strict=True)
    added = [disturbance.draw(generator("disturbance", seed), sensors, n_in_rpm, time) for seed, n_in_rpm in facts]
    return replace(recordings, signals=(recordings.signals + np.stack(added)).astype("f4"))


def _part(plan: Plan, cases: list[Case], file: Path) -> Part:
    """Simulate one block and write it, unless a valid part exists."""
    flaw = _flaw(plan, cases, file) if file.exists() else ""
    if flaw or not file.exists():
        with threadpool_limits(1):  # so that the bytes do not depend on the number of cores
            recordings = record(plan, cases)
        with sole_maker(file, wait=True):  # a worker of a killed run may write this part
            storage.write(file, [recordings], len(recordings))
    return Part(len(cases), flaw, usage())


def _read(plan: Plan, file: Path) -> LabelledSignals:
    """Read a part; a worker of a killed run with another plan may have replaced it."""
    part = storage.read(file)
    if not plan.attributes.items() <= part.attributes.items():
        raise ValueError(f"{file}: made by other choices or code")
    return part


def _flaw(plan: Plan, cases: list[Case], file: Path) -> str:
    """Reason why an existing part does not fit the plan; empty if it does."""
    try:
        part = _read(plan, file)
    except ValueError as damage:
        return str(damage)
    if part.signals.shape[2] != plan.window.samples or list(part.table["seed"]) != [case.seed for case in cases]:
        return f"{file}: not the recordings that belong there"
    return ""
