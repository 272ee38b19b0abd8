"""What a task, a recording and a training job cost on each engine: ``python scripts/scale.py`` (docs/scale.md)."""

import argparse
import math
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median

from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

from swgsim.common.compute import Engine
from swgsim.dataset.dataset import generate
from swgsim.jobs import generate_data_set as generation
from swgsim.jobs import settings

TASKS = 400
CONF = Path(__file__).parents[1] / "conf"


def main() -> None:
    """Print a table; every figure is the median of so many runs."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--grid", default="paper", help="a file of conf/grid: the data set that is made")
    asked.add_argument("--repeats", type=int, default=3)
    asked.add_argument("--classifiers", default="rf,extra_trees,cnn", help="files of conf/classifier: the jobs")
    chosen = asked.parse_args()
    print("| engine | workers | ms per empty task | s per data set | of which after the last part | times one worker |")
    print("|---|--:|--:|--:|--:|--:|")
    for name, engines in (("this machine", local), ("Dask", dask)):
        alone = 0.0
        for workers in (1, 2):
            with engines(workers) as engine:
                empty = median(seconds(lambda: hand_out(engine)) for _ in range(chosen.repeats)) / TASKS
                runs = [data_set(composed("generate", f"grid={chosen.grid}"), engine) for _ in range(chosen.repeats)]
            whole, joining = (median(column) for column in zip(*runs, strict=True))
            alone = alone or whole
            print(
                f"| {name} | {workers} | {1e3 * empty:.2f} | {whole:.2f} | {joining:.2f} | {alone / whole:.2f} |",
                flush=True,
            )
    print()
    unit_costs(chosen.grid, chosen.classifiers.split(","))


def composed(script: str, *words: str) -> dict:
    """The configuration of a script."""
    with initialize_config_dir(str(CONF), version_base="1.3"):
        return OmegaConf.to_container(compose(script, list(words)), resolve=True)  # type: ignore[return-value]


@contextmanager
def local(workers: int) -> Iterator[Engine]:
    """Processes of this machine."""
    yield warm(Engine(workers))


@contextmanager
def dask(workers: int) -> Iterator[Engine]:
    """A Dask cluster on this machine."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster:
        yield warm(Engine(scheduler=cluster.scheduler_address))


def warm(engine: Engine) -> Engine:
    """An engine whose workers have imported what they need."""
    with tempfile.TemporaryDirectory() as folder:
        generate(settings.plan(composed("generate", "grid=small")), Path(folder) / "a.h5", engine, lambda _: None)
    return engine


def seconds(work: Callable[[], object]) -> float:
    """How long something takes."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def hand_out(engine: Engine) -> None:
    """Tasks that do nothing."""
    for _ in engine.results(math.sqrt, ((2.0,) for _ in range(TASKS)), TASKS):
        pass


def data_set(config: dict, engine: Engine) -> tuple[float, float]:
    """Seconds to make a data set, and those after the last part."""
    parts: list[float] = []
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        generate(settings.plan(config), Path(folder) / "a.h5", engine, lambda _: parts.append(time.perf_counter()))
        end = time.perf_counter()
    return end - start, end - parts[-1]


def unit_costs(grid: str, classifiers: list[str]) -> None:
    """Of one recording and of one job, on one core."""
    from learn.jobs import train_job as job  # with torch, which the workers need not load

    with tempfile.TemporaryDirectory() as folder:
        where = f"data={folder}"
        config = composed("generate", f"grid={grid}", where, "workers=1")
        made = generation.run(config)
        print("| unit | s | bytes kept |\n|---|--:|--:|")
        size = Path(made["path"]).stat().st_size / made["recordings"]
        print(f"| recording | {made['seconds'] / made['recordings']:.2e} | {size:.0f} |")
        for classifier in classifiers:
            runs = Path(folder) / classifier
            words = [f"grid={grid}", where, f"classifier={classifier}", f"tracking.folder={runs}"]
            took = seconds(lambda: job.run(composed("train", *words)))  # noqa: B023
            kept = sum(file.stat().st_size for file in (runs / "artifacts").rglob("*") if file.is_file())
            print(f"| job of {classifier} | {took:.1f} | {kept} |", flush=True)


if __name__ == "__main__":
    main()
