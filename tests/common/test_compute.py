"""Engines: the same bytes of each, workers and schedulers that die, and clusters that are not fit."""

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from operator import neg
from pathlib import Path

import pytest
from chain_fixtures import small_plan
from fabricated import recordings
from prepared_store import prepared

from learn import tracking
from swgsim.common import cluster
from swgsim.common.compute import Engine
from swgsim.dataset import dataset
from swgsim.dataset import plan as plans
from swgsim.storage import storage

pytestmark = [pytest.mark.end_to_end, pytest.mark.slow]
ROOT = Path(__file__).parents[2]
NOBODY = "tcp://127.0.0.1:9"

distributed = pytest.importorskip("distributed", reason="Dask is not installed: make install")


@dataclass
class Cluster:
    """Processes of a scheduler and of its workers."""

    address: str
    scheduler: subprocess.Popen
    workers: list[subprocess.Popen]


@contextmanager
def started(folder: Path, *workers: tuple[str, ...]) -> Iterator[Cluster]:
    """A cluster of processes of its own, each worker with its options; they work in another folder than the tests."""
    file = folder / "scheduler.json"
    common = ("--scheduler-file", str(file), "--no-dashboard")
    with ExitStack() as stack, (folder / "log").open("w") as log:

        def process(*words: str) -> subprocess.Popen:
            command = [sys.executable, "-m", "distributed.cli." + words[0], *words[1:], *common]
            made = subprocess.Popen(command, cwd=folder, stdout=log, stderr=log)
            stack.callback(made.wait)
            stack.callback(made.kill)
            return made

        scheduler = process("dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-show")
        alone = ("dask_worker", "--host", "127.0.0.1", "--no-nanny", "--local-directory", str(folder))
        members = [process(*alone, *options) for options in workers]
        while not file.exists():
            assert scheduler.poll() is None
            time.sleep(0.1)
        # Written in place, so that it may be there in part.
        address = distributed.utils.json_load_robust(file, timeout=60)["address"]
        if members:
            with distributed.Client(address, set_as_default=False) as client:
                client.wait_for_workers(len(members), timeout=120)
        yield Cluster(address, scheduler, members)


ONE_THREAD = ("--nthreads", "1")


@pytest.fixture(scope="module")
def two_workers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with started(tmp_path_factory.mktemp("cluster"), ONE_THREAD, ONE_THREAD) as both:
        yield both.address


@pytest.fixture
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Six blocks in the small plan."""
    monkeypatch.setattr(plans, "BLOCK", 10)


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The small plan's data set, made by two processes of this machine."""
    path = tmp_path_factory.mktemp("data") / "a.h5"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(plans, "BLOCK", 10)
        dataset.generate(small_plan(), path, Engine(2), lambda _: None)
    return path.read_bytes()


@pytest.mark.usefixtures("small_blocks")
def test_a_cluster_makes_the_same_bytes(
    two_workers: str, expected: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # where the workers are not
    dataset.generate(small_plan(), Path("a.h5"), Engine(scheduler=two_workers), lambda _: None)
    assert Path("a.h5").read_bytes() == expected
    assert [p.name for p in tmp_path.iterdir()] == ["a.h5"]


def test_tasks_wait_where_no_worker_is_there_for_a_moment(two_workers: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """As at the end of an allocation, when all that was handed out is done."""
    monkeypatch.setattr(distributed.Client, "ncores", lambda _: {})
    assert list(Engine(scheduler=two_workers).results(neg, ((i,) for i in range(5)), 5)) == [0, -1, -2, -3, -4]


@pytest.mark.usefixtures("small_blocks")
def test_a_killed_worker_and_a_lost_scheduler_lose_nothing(expected: bytes, tmp_path: Path) -> None:
    (tmp_path / "cluster").mkdir()
    path, other = tmp_path / "a.h5", tmp_path / "b.h5"
    lost = r"the Dask scheduler at tcp://127.0.0.1:\d+ was lost; .* the same command"
    with started(tmp_path / "cluster", ONE_THREAD, ONE_THREAD) as both:
        engine = Engine(scheduler=both.address)
        dataset.generate(small_plan(), path, engine, lambda _: both.workers[0].kill())
        assert both.workers[0].wait() < 0
        assert both.workers[1].poll() is None
        with pytest.raises(ValueError, match=lost):
            dataset.generate(small_plan(), other, engine, lambda _: both.scheduler.kill())
    assert not other.exists()
    assert list((tmp_path / ".b.h5.parts").glob("*.h5"))
    dataset.generate(small_plan(), other, Engine(1), lambda _: None)
    assert path.read_bytes() == other.read_bytes() == expected


def test_an_absent_scheduler_is_told_of_within_seconds(monkeypatch: pytest.MonkeyPatch) -> None:
    assert cluster.PRESENCE <= 10
    monkeypatch.setattr(cluster, "PRESENCE", 1)
    with pytest.raises(ValueError, match=rf"no Dask scheduler answers at scheduler={NOBODY} .*or use compute=local"):
        list(Engine(scheduler=NOBODY).results(neg, [(1,)], 1))


@pytest.mark.parametrize(
    ("workers", "message"),
    [
        ((), "has no worker, .* start them with 'dask worker tcp://"),
        ((("--nthreads", "2"),), "has 2 threads, must have 1: add --nthreads 1"),
        (((*ONE_THREAD, "--preload", "stranger.py"),), "cannot import swgsim .*install this project there"),
    ],
)
def test_workers_that_are_not_fit_are_named(
    workers: tuple, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "PRESENCE", 10 if workers else 1)
    (tmp_path / "stranger.py").write_text("import sys\nsys.modules['swgsim'] = None\n")  # as if it were not installed
    with started(tmp_path, *workers) as unfit, pytest.raises(ValueError, match=message):
        list(Engine(scheduler=unfit.address).results(neg, [(1,)], 1))


@pytest.mark.parametrize(
    ("other", "message"),
    [
        ({"installed": "swgsim of today"}, r"worker tcp://.* has swgsim \d.*, must have swgsim of today: install"),
        ({"folder": "/no/such/folder"}, "has no folder /no/such/folder: work in one that all share"),
    ],
)
def test_workers_of_other_code_or_another_folder_are_named(
    other: dict[str, str], message: str, two_workers: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = cluster.own_place(str)._replace(**other)
    monkeypatch.setattr(cluster, "own_place", lambda _: place)
    with pytest.raises(ValueError, match=message):
        list(Engine(scheduler=two_workers).results(neg, [(1,)], 1))


def test_a_worker_of_other_code_that_joins_later_does_no_task() -> None:
    with pytest.raises(ValueError, match=r"a worker on .* must have swgsim of today"):
        cluster.task_of_another(cluster.own_place(str)._replace(installed="swgsim of today"), str, neg, (1,))


def test_a_worker_that_differs_beside_the_chain_does_no_task() -> None:
    with pytest.raises(ValueError, match=r"a worker on .* has swgsim .* learn of today, must have swgsim"):
        cluster.task_of_another(cluster.own_place(lambda: "learn of yesterday"), lambda: "learn of today", neg, (1,))


@pytest.mark.parametrize(
    ("chosen", "message"),
    [
        ({"compute": "slurm"}, "unknown choice 'slurm' of compute; choose from local, dask"),
        ({"compute": "dask"}, "compute is dask and scheduler is None: choose .* scheduler=tcp://127.0.0.1:8786"),
        ({"scheduler": NOBODY}, f"compute is local and scheduler is {NOBODY}"),
        ({"compute": "dask", "scheduler": "here"}, "scheduler is 'here', must be an address such as tcp://"),
    ],
)
def test_engines_that_are_none_are_answered_with_the_choices(chosen: dict[str, str], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Engine.of({"workers": None, **chosen})


@pytest.mark.parametrize(("engine", "classifiers"), [("dask", ["knn", "nb"]), ("submitit", ["nb"])])
def test_a_sweep_elsewhere_loses_no_run(engine: str, classifiers: list[str], two_workers: str, tmp_path: Path) -> None:
    made = recordings(variants=4)
    storage.write(tmp_path / "small-clean.h5", [made], len(made))
    where = ["grid=small", f"data={tmp_path}", f"tracking.folder={prepared(tmp_path)}", f"hydra.sweep.dir={tmp_path}"]
    words = ["compute=dask", f"scheduler={two_workers}"] if engine == "dask" else ["hydra/launcher=submitit_local"]
    command = [sys.executable, "-m", "swgsim", "train", "-m", f"classifier={','.join(classifiers)}", *where, *words]
    answer = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stderr
    store = tracking.local_store(str(tmp_path))
    assert sorted(tracking.finished_runs(store)["classifier"]) == classifiers
    (sweep,) = store.client.search_runs([store.experiment_id], "tags.kind = 'sweep'")
    jobs = store.client.search_runs([store.experiment_id], "tags.kind = 'job'")
    assert [job.data.tags["mlflow.parentRunId"] for job in jobs] == [sweep.info.run_id] * len(classifiers)
