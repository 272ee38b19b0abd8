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
from pathlib import Path

import joblib
import numpy as np
from threadpoolctl import threadpool_limits

from swgsim import storage
from swgsim.disturbance import Disturbance
from swgsim.plan import BLOCK, Plan, provenance
from swgsim.record import record
from swgsim.recordings import COLUMNS, Recordings, facts
from swgsim.seeds import generator


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
