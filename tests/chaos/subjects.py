"""What is killed: the making of data sets and a sweep of training, in forks of this process and by the command line."""

import os
import runpy
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import mlflow  # noqa: F401  so that forks need not import it
import sklearn.naive_bayes
import sklearn.neighbors  # noqa: F401
from fabricated import recordings
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

from learn import tracking
from learn.jobs import train_job  # noqa: F401
from learn.tracking import ui  # noqa: F401
from swgsim.dataset import plan as plans
from swgsim.jobs import generate_data_set as generation
from swgsim.storage import storage

ROOT = Path(__file__).parents[2]
GRID = ("grid=small", "condition=disturbed")  # which makes the clean data set first
FEW = ("grid.variants=3", "grid.positions=1", "grid.references=1")  # 76 recordings of each gear
BLOCK = 26  # recordings in a part: three parts of each gear
JOBS = ("classifier=knn,nb", "features=selection_1,selection_3")
TIMES = "seconds"  # in the names of metrics that are times


class Subject(NamedTuple):
    """A piece of work in a folder.

    ``work`` does it, or goes on with it; ``phase`` says how far it came; ``result`` is what must be the same at the end
    whether it was killed or not.
    """

    work: Callable[[Path], object]
    phase: Callable[[Path], str]
    result: Callable[[Path], dict[str, Any]]


def data_sets(folder: Path) -> None:
    """Both data sets, by the library and in this very process."""
    plans.BLOCK = BLOCK
    with initialize_config_dir(str(ROOT / "conf"), version_base="1.3"):
        config = compose("generate", [*GRID, *FEW, f"data={folder / 'data'}", "workers=1"])
    generation.run(OmegaConf.to_container(config, resolve=True))  # type: ignore[arg-type]


def training_data(folder: Path) -> None:
    """What the sweeps train on."""
    made = recordings(variants=4)
    storage.write(folder / "small-clean.h5", [made], len(made))


def sweep(data: Path, folder: Path) -> None:
    """The jobs one after the other, in this very process."""
    script = ROOT / "scripts" / "train.py"
    sys.path.insert(0, str(script.parent))
    sys.argv = [str(script), *_swept(data, folder), "workers=1"]
    runpy.run_path(str(script), run_name="__main__")


def command(script: str, *words: str) -> None:
    """This process becomes the command."""
    os.chdir(ROOT)
    os.execv(sys.executable, [sys.executable, f"scripts/{script}.py", *words])


def subjects(data: Path) -> dict[str, Subject]:
    """By name; ``data`` is the folder of the :func:`training_data`."""

    def generated(folder: Path) -> None:
        command("generate", *GRID, f"data={folder / 'data'}", "workers=2")

    def swept(folder: Path) -> None:
        command("train", *_swept(data, folder), "workers=2")

    return {
        "data set, in a fork": Subject(data_sets, parts_there, files),
        "data set, scripts/generate.py": Subject(generated, parts_there, files),
        "sweep, in a fork": Subject(partial(sweep, data), runs_begun, finished),
        "sweep, scripts/train.py": Subject(swept, runs_begun, finished),
    }


def _swept(data: Path, folder: Path) -> list[str]:
    where = (f"data={data}", f"tracking.folder={folder / 'runs'}", f"models={folder / 'models'}")
    return ["-m", "grid=small", *JOBS, *where, f"hydra.sweep.dir={folder / 'outputs'}"]


def parts_there(folder: Path) -> str:
    """How far the data sets came."""
    there = {path.name for path in (folder / "data").glob("*")}
    if "small-disturbed.h5" in there:
        return "both made"
    if "small-clean.h5" in there:
        return "clean one made"
    return f"{len(list((folder / 'data' / '.small-clean.h5.parts').glob('*.h5')))} parts"


def runs_begun(folder: Path) -> str:
    """How far the sweep came, by what lies in its folder; the database is left as the kill left it."""
    if not (folder / "runs" / "mlflow.db").exists():
        return "no store"
    return f"{len(list((folder / 'runs' / 'artifacts').glob('*')))} runs begun"


def files(folder: Path) -> dict[str, Any]:
    """All files of data sets with their bytes, and the names of all others: none may be left over."""
    found = {path.name: path for path in (folder / "data").iterdir()}
    return {name: path.read_bytes() if path.suffix == ".h5" else b"" for name, path in found.items()}


def finished(folder: Path) -> dict[str, Any]:
    """The metrics of the finished runs of every job, but for times."""
    store = tracking.local_store(str(folder / "runs"))
    found: dict[str, Any] = {}
    query = "tags.kind = 'job' and attributes.status = 'FINISHED'"
    for run in store.client.search_runs([store.experiment_id], query):
        metrics = {name: value for name, value in run.data.metrics.items() if TIMES not in name}
        found.setdefault(run.data.tags["key"], []).append(metrics)
    return found
