"""Every experiment file runs on a small grid, and a parallel sweep neither locks nor loses runs."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from fabricated import LOADS, recordings
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf
from prepared_store import prepared, store_in

from learn import tracking
from learn.jobs import train_job as job
from learn.jobs.sweep import Sweep, named_on_command_line
from swgsim.storage import storage

pytestmark = [pytest.mark.end_to_end, pytest.mark.slow]
ROOT = Path(__file__).parents[2]
EXPERIMENTS = sorted(path.stem for path in (ROOT / "conf" / "experiment").glob("*.yaml"))


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data")
    for condition, disturbance in (("clean", 0.0), ("disturbed", 0.002), ("bench", 0.001)):
        made = recordings(variants=4, disturbance=disturbance)
        storage.write(folder / f"small-{condition}.h5", [made], len(made))
    shutil.copy(folder / "small-bench.h5", folder / "training-bench.h5")
    return folder


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    return prepared(tmp_path_factory.mktemp("runs"))


@pytest.fixture(scope="module")
def ran():
    """Rows, protocol, features, classifier and adaptation of the jobs that have run."""
    return set()


def composed(*overrides, **options):
    with initialize_config_dir(str(ROOT / "conf"), version_base="1.3"):
        return compose("train", list(overrides), **options)


# For experiments on new gears, which want more gears and variants than the small grid has.
FEW = [
    "protocol.development=0", "protocol.labelled=1", "protocol.unlabelled=1", "protocol.kept_out=1", "shots=[1]",
    "draws=1",
]  # fmt: skip


# Enough for a job to run; what an experiment sweeps stays as it is.
SMALLER = {
    "trees": 5,
    "count": 5,
    "epochs": 1,
    "iterations": 10,
    "steps": 5,
    "neurons": 8,
    "width": 8,
    "folds": 2,
    "gears": 3,
}


def jobs(params):
    """As many jobs as it takes to use every value of a sweep once."""
    sweep = {key: values.split(",") for key, values in params.items()}
    for number in range(max(map(len, sweep.values()))):
        yield {key: values[number % len(values)] for key, values in sweep.items()}


def smaller(config, swept):
    for group in ("classifier", "adaptation", "protocol"):
        config[group] |= {
            option: value
            for option, value in SMALLER.items()
            if option in config[group] and f"{group}.{option}" not in swept
        }
    if config["classifier"]["name"] == "fast_twin":
        config["classifier"]["grid"]["loads_nm"] = list(LOADS)  # of the made-up recordings
        config["classifier"] |= {"variants": 2, "mesh": {**config["classifier"]["mesh"], "sectors": 40}}
    if config["adaptation"]["name"] == "rezero":  # of the three gears two must be sources
        config["adaptation"]["shots"], config["protocol"]["judged"] = [0, 1], 1
    return config


def run_ids(folder, study):
    """The finished runs of a study, to which other experiments may add."""
    found = tracking.finished_runs(tracking.local_store(str(folder)), study=study)
    return set(found["run_id"]) if len(found) else set()


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_every_experiment_runs_on_a_small_grid(experiment, data, runs, ran):
    """All of its jobs are composed. Those run that differ from all before in more than an option, and always one."""
    where = ["grid=small", f"data={data}", f"tracking.folder={runs}", f"models={runs / 'models'}"]
    whole = composed(f"experiment={experiment}", return_hydra_config=True)
    few = FEW if whole.protocol.name == "new_gears" else []
    few = [*few, "protocol.judged=3"] if whole.protocol.get("judged") else few
    before, run = run_ids(runs, whole.study), 0
    for swept in jobs(whole.hydra.sweeper.params):
        overrides = [f"{key}={value}" for key, value in swept.items()]
        config = composed(f"experiment={experiment}", *few, *overrides, *where)
        groups = ("protocol", "features", "classifier", "adaptation")
        parts = (config.rows, *(config[group].name for group in groups))
        if run and parts in ran:
            continue
        metrics = job.run(smaller(OmegaConf.to_container(config, resolve=True), swept))
        assert 0 <= metrics["test_score"] <= 100
        ran.add(parts)
        run += 1
    assert len(run_ids(runs, whole.study) - before) == run


def train(*arguments):
    command = [sys.executable, "-m", "swgsim", "train", *arguments]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)


def test_parallel_sweep_loses_no_run_and_a_finished_job_is_not_done_again(data, tmp_path, monkeypatch):
    store = store_in(tmp_path / "runs")
    where = ["grid=small", f"data={data}", f"tracking.folder={store.folder}", "features=selection_1"]
    answer = train("-m", "experiment=table10", "workers=2", *where, f"hydra.sweep.dir={tmp_path}", "classifier=nb,knn")
    assert answer.returncode == 0, answer.stderr
    found = tracking.finished_runs(store).set_index("classifier")
    assert sorted(found.index) == ["knn", "nb"]
    assert {"test/1_2_to_3", "test/2_3_to_1", "test/1_3_to_2"} < set(found.columns)

    children = store.client.search_runs([store.experiment_id], "tags.kind = 'job'")
    names = sorted(run.info.run_name for run in children)
    assert [name.split()[:4] for name in names] == [
        ["leave_one_gear_out", classifier, "selection_1", "table10"] for classifier in ("knn", "nb")
    ]
    assert len({run.data.tags["mlflow.parentRunId"] for run in children}) == 1
    artifacts = {a.path for a in store.client.list_artifacts(children[0].info.run_id)}
    assert artifacts == {"config.yaml", "figures"}

    monkeypatch.setattr(job.zero_shot, "results", None)  # nothing is trained
    config = composed("experiment=table10", *where, "classifier=nb", "protocol=leave_one_gear_out")
    again = job.run(OmegaConf.to_container(config, resolve=True))
    assert again["test_score"] == found.loc["nb", "test_score"]


THREADS = """
import sys
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf
from threadpoolctl import threadpool_info
from learn.jobs import train_job
def results(config, data):
    import sklearn.ensemble
    print([each["num_threads"] for each in threadpool_info() if each["user_api"] == "openmp"])
    return {"test_score": 0.0}, {}, {}
train_job.zero_shot.results = results
with initialize_config_dir(sys.argv[1], version_base="1.3"):
    train_job.run(OmegaConf.to_container(compose("train", sys.argv[2:]), resolve=True))
"""


def test_a_job_has_one_thread_though_scikit_learn_is_loaded_by_it(data, tmp_path):
    words = ["grid=small", f"data={data}", f"tracking.folder={store_in(tmp_path).folder}"]
    command = [sys.executable, "-c", THREADS, str(ROOT / "conf"), *words]
    two = {**os.environ, "OMP_NUM_THREADS": "2"}
    answer = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, env=two, check=False)
    assert answer.stdout.split() == ["[1]"], answer.stderr


def test_a_sweep_without_an_experiment_is_kept_as_one(tmp_path):
    store = store_in(tmp_path)
    words = ["classifier=nb", "grid=small", f"tracking.folder={tmp_path}"]
    config = composed(*words, return_hydra_config=True)
    config.hydra.overrides.task = words
    sweep = Sweep()
    sweep.on_multirun_start(config)
    (run,) = store.client.search_runs([store.experiment_id], "tags.kind = 'sweep'")
    assert (run.info.run_name, run.info.status) == ("trial small", "RUNNING")
    assert f"+hydra.job.env_set.{tracking.SWEEP}={run.info.run_id}" in config.hydra.overrides.hydra
    sweep.on_multirun_end(config)
    assert store.client.get_run(run.info.run_id).info.status == "FINISHED"


def test_a_sweep_stops_at_the_start_if_the_server_is_absent():
    config = composed("tracking=server", "tracking.uri=http://127.0.0.1:9", return_hydra_config=True)
    with pytest.raises(SystemExit, match=r"no MLflow server answers at tracking\.uri=http://127\.0\.0\.1:9"):
        Sweep().on_multirun_start(config)


def test_command_line_wins_over_the_sweep_of_an_experiment():
    named = named_on_command_line(["experiment=table7", "classifier=rf,knn", "+new=1", "~old"])
    assert named == {"experiment": "table7", "classifier": "rf,knn", "new": "1", "old": ""}


@pytest.mark.parametrize("uri", [None, "http://127.0.0.1:5999"])
def test_the_server_is_that_of_the_environment_unless_one_is_named(monkeypatch, uri):
    monkeypatch.delenv("MLFLOW_TRACKING_URI", raising=False)
    if uri:
        monkeypatch.setenv("MLFLOW_TRACKING_URI", uri)
    assert composed("tracking=server").tracking.uri == (uri or "http://127.0.0.1:5000")
    assert composed("tracking=server", "tracking.uri=http://there:5000").tracking.uri == "http://there:5000"
