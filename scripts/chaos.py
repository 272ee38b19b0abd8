"""Kill data sets and sweeps at random moments: ``python scripts/chaos.py --kills 200`` (docs/reliability.md).

The work runs in forks of this process, as a command takes seconds to start. A killed work starts again until it ends.
"""

import argparse
import os
import runpy
import select
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import mlflow  # noqa: F401  (imported once, before the forks)
import numpy as np
import sklearn.naive_bayes
import sklearn.neighbors  # noqa: F401
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))  # for the training data

from fabricated import recordings

from learn import tracking
from learn.jobs import train_job  # noqa: F401
from learn.tracking import ui  # noqa: F401
from swgsim.dataset import plan as plans
from swgsim.jobs import generate_data_set as generation
from swgsim.storage import storage

ROOT = Path(__file__).parents[1]
FEW = ("grid=small", "condition=disturbed", "grid.variants=3", "grid.positions=1", "grid.references=1", "workers=1")
BLOCK = 26  # recordings in a part of a data set: three parts of each gear
JOBS = ("-m", "grid=small", "classifier=knn,nb", "features=selection_1,selection_3", "workers=1")


class Work(NamedTuple):
    """A piece of work in a folder: ``do`` starts or continues it, ``result`` must not depend on kills."""

    do: Callable[[Path], object]
    result: Callable[[Path], dict[str, Any]]


def data_sets(folder: Path) -> None:
    """The disturbed data set, after the clean one."""
    plans.BLOCK = BLOCK
    with initialize_config_dir(str(ROOT / "conf"), version_base="1.3"):
        config = compose("generate", [*FEW, f"data={folder / 'data'}"])
    generation.run(OmegaConf.to_container(config, resolve=True))  # type: ignore[arg-type]


def files(folder: Path) -> dict[str, Any]:
    """Bytes of the data sets, and names of all other files: none may be left over."""
    found = {path.name: path for path in (folder / "data").iterdir()}
    return {name: path.read_bytes() if path.suffix == ".h5" else b"" for name, path in found.items()}


def training_data(folder: Path) -> None:
    """The data set of the sweep."""
    made = recordings(variants=4)
    storage.write(folder / "small-clean.h5", [made], len(made))


def sweep(folder: Path) -> None:
    """Four jobs, one after the other."""
    script = ROOT / "scripts" / "train.py"
    sys.path.insert(0, str(script.parent))
    where = (f"data={folder.parent}", f"tracking.folder={folder / 'runs'}", f"models={folder / 'models'}")
    sys.argv = [str(script), *JOBS, *where, f"hydra.sweep.dir={folder / 'outputs'}"]
    runpy.run_path(str(script), run_name="__main__")


def finished(folder: Path) -> dict[str, Any]:
    """Metrics of the finished runs of every job, without times."""
    store = tracking.local_store(str(folder / "runs"))
    found: dict[str, Any] = {}
    query = "tags.kind = 'job' and attributes.status = 'FINISHED'"
    for run in store.client.search_runs([store.experiment_id], query):
        metrics = {name: value for name, value in run.data.metrics.items() if "seconds" not in name}
        found.setdefault(run.data.tags["key"], []).append(metrics)
    return found


WORKS = {"data sets": Work(data_sets, files), "sweep": Work(sweep, finished)}


def attempt(work: Callable[[Path], object], folder: Path, seconds: float | None, log: Path) -> int:
    """Do work in a forked process and kill its group after a time; returns its exit status, negative for a signal."""
    child = os.fork()
    if not child:
        status = 1
        try:
            os.setpgid(0, 0)
            output = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
            os.dup2(output, 1)
            os.dup2(output, 2)
            work(folder)
            status = 0
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(status)
    with suppress(PermissionError):
        os.setpgid(child, child)
    with os.fdopen(os.pidfd_open(child)) as ended:
        if not select.select([ended], [], [], seconds)[0]:
            os.killpg(child, signal.SIGKILL)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def campaign(work: Work, kills: int, rng: np.random.Generator, place: Path) -> tuple[int, list[str]]:
    """Number of works with kills at random moments, and what differs from the undisturbed work in their results."""
    log, undisturbed = place / "log", place / "undisturbed"
    undisturbed.mkdir()
    start = time.monotonic()
    if attempt(work.do, undisturbed, None, log):
        raise RuntimeError(f"the undisturbed work failed: {log.read_text()[-2000:]}")
    duration = time.monotonic() - start
    expected, count, wrong = work.result(undisturbed), 0, []
    while kills > 0:
        folder = place / f"work-{count}"
        folder.mkdir()
        count += 1
        while (status := attempt(work.do, folder, rng.uniform(0, duration) if kills > 0 else None, log)) < 0:
            kills -= 1
        found = work.result(folder) if not status else {f"no restart: {log.read_text()[-500:]}": None}
        wrong += [name for name in expected.keys() | found.keys() if found.get(name) != expected.get(name)]
        shutil.rmtree(folder)
    return count, wrong


def main() -> int:
    """Print a table; the exit status is 1 if anything is missing, different or left over."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=200, help="half of them for each work")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    print("| work | starts | kills | missing, different or left over |\n|---|--:|--:|---|", flush=True)
    harm = False
    for number, (name, work) in enumerate(WORKS.items()):
        with tempfile.TemporaryDirectory(prefix="chaos") as scratch:
            os.environ["TMPDIR"] = tempfile.tempdir = scratch  # killed processes leave temporary files
            training_data(Path(scratch))
            kills = max(1, options.kills // len(WORKS))
            works, wrong = campaign(work, kills, np.random.default_rng([options.seed, number]), Path(scratch))
            tempfile.tempdir = None
        print(f"| {name} | {works} | {kills} | {'; '.join(wrong)} |", flush=True)
        harm |= bool(wrong)
    print("\nnothing lost, nothing differs" if not harm else "\nresults depend on the kills")
    return int(harm)


if __name__ == "__main__":
    sys.exit(main())
