"""A team's server: many jobs at once, a server that goes away, and what waits until it is back."""

import multiprocessing
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pandas as pd
import pytest
from fabricated import recordings
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf
from prepared_store import prepared

from learn import tracking
from learn.jobs import train_job as job
from learn.jobs import zero_shot
from learn.tracking import postgresql
from swgsim.storage import storage

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
SECONDS_TO_START = 600  # on a machine that does much else; it takes ten on an idle one
JOBS = 8
# A server that does not import everything anew for each of the jobs.
PROCESSES = multiprocessing.get_context("forkserver")
PROCESSES.set_forkserver_preload(["learn.tracking", "mlflow", "mlflow.store.artifact.mlflow_artifacts_repo", "pyarrow"])


def free_port():
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return trial.getsockname()[1]


class TeamServer:
    def __init__(self, folder):
        self.folder, self.port = folder, free_port()
        self.uri = f"http://127.0.0.1:{self.port}"

    def start(self):
        serve = f"serve_team(Path({str(self.folder)!r}), '127.0.0.1', {self.port}, 1, None)"
        program = f"from pathlib import Path; from learn.tracking.server import serve_team; {serve}"
        with (self.folder / "output.txt").open("w") as output:
            self.process = subprocess.Popen([sys.executable, "-c", program], stdout=output, stderr=output)
        end = time.monotonic() + SECONDS_TO_START
        while f"tracking.uri={self.uri}" not in self.output():  # printed once the server answers
            assert self.process.poll() is None, self.output()
            assert time.monotonic() < end, self.output()
            time.sleep(0.2)

    def output(self):
        return (self.folder / "output.txt").read_text()

    def stop(self):
        self.process.terminate()
        assert self.process.wait(SECONDS_TO_START) == 0, self.output()

    def store(self, pending=None):
        return tracking.server_store(self.uri, pending=pending and str(pending))


@pytest.fixture(scope="module")
def server():
    if not shutil.which("postgres") and not list(postgresql.DEBIAN.glob("*/bin/postgres")):
        pytest.skip("PostgreSQL is not installed: 'apt-get install postgresql'")
    folder = Path(tempfile.mkdtemp())
    folder.chmod(0o711)  # as root, PostgreSQL steps down to a user who has to get there; pytest's folders keep him out
    running = TeamServer(folder)
    try:
        running.start()
        yield running
    finally:
        if running.process.poll() is None:
            running.stop()
        shutil.rmtree(folder)


def keep(store, number, study="many"):
    table = pd.DataFrame({"number": [number], "square": [number**2]})
    parameters = {"study": study, "grid": "small", "number": number}
    tags = {"data_digest": "d"}
    with tracking.job_run(store, f"{study} {number}", f"{study}-{number}", parameters, {"number": number}, tags) as run:
        metrics = {"test_score": number, **{f"m/{i}": number + i / 100 for i in range(50)}}
        run.record(metrics, {}, {"tables/t.parquet": table})


def join_in(uri, number):
    keep(tracking.server_store(uri), number)


def test_many_jobs_at_once_lose_no_run_and_no_metric(server):
    jobs = [PROCESSES.Process(target=join_in, args=(server.uri, number)) for number in range(JOBS)]
    for each in jobs:
        each.start()
    for each in jobs:
        each.join()
    assert [each.exitcode for each in jobs] == [0] * JOBS
    store = server.store()
    found = tracking.finished_runs(store, study="many").astype({"number": int}).set_index("number").sort_index()
    assert list(found.index) == list(range(JOBS))
    for number, run in found.iterrows():
        assert [run[f"m/{i}"] for i in range(50)] == [number + i / 100 for i in range(50)]
        assert tracking.table_of(store, run["run_id"], "tables/t.parquet").to_numpy().tolist() == [[number, number**2]]
    assert len(store.client.search_runs([store.experiment_id], "params.study = 'many'")) == JOBS


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data")
    made = recordings(variants=4)
    storage.write(folder / "small-clean.h5", [made], len(made))
    return folder


def configured(data, *tracked):
    few = [f"protocol.{part}" for part in ("development=0", "labelled=1", "unlabelled=1", "kept_out=1")]
    words = ["grid=small", f"data={data}", "protocol=new_gears", "classifier=nb", *few, *tracked]
    with initialize_config_dir(str(ROOT / "conf"), version_base="1.3"):
        return OmegaConf.to_container(compose("train", words), resolve=True)


def on_server(data, uri, pending):
    return configured(data, "tracking=server", f"tracking.uri={uri}", f"tracking.pending={pending}")


def not_trained(*_):
    raise AssertionError("a job was trained that should not be")


@pytest.fixture(scope="module")
def lost(server, data, tmp_path_factory):
    """A job of a sweep whose server goes away while it works and is then started again; and its metrics."""
    pending = prepared(tmp_path_factory.mktemp("pending"))
    config = on_server(data, server.uri, pending)
    judge = zero_shot.results
    keep(server.store(), 5, study="before")

    def results(*arguments):
        server.stop()
        return judge(*arguments)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(zero_shot, "results", results)
        patch.setenv(tracking.SWEEP, tracking.open_sweep(server.store(), "trial", "small"))
        metrics = job.run(config)
    server.start()
    return pending, metrics


def test_a_job_whose_server_goes_away_ends_as_it_would_without_and_is_not_done_again(
    server, data, lost, tmp_path, monkeypatch
):
    pending, metrics = lost
    undisturbed = configured(data, f"tracking.folder={prepared(tmp_path)}")
    times = {name: metrics[name] for name in ("fit_seconds", "milliseconds")}
    assert metrics == {**job.run(undisturbed), **times}
    (before,) = tracking.finished_runs(server.store(), study="before").itertuples()  # the server keeps its runs
    assert tracking.table_of(server.store(), before.run_id, "tables/t.parquet").to_numpy().tolist() == [[5, 25]]
    stores = [tracking.local_store(str(folder)) for folder in (pending, tmp_path)]
    runs = [tracking.finished_runs(store, study="trial")["run_id"].item() for store in stores]
    pd.testing.assert_frame_equal(*map(tracking.table_of, stores, runs, ["tables/predictions.parquet"] * 2))
    monkeypatch.setattr(zero_shot, "results", not_trained)
    assert job.run(on_server(data, f"http://127.0.0.1:{free_port()}", pending)) == metrics


def test_jobs_of_a_sweep_go_on_without_their_server_and_say_so(data, tmp_path, monkeypatch, caplog):
    uri = f"http://127.0.0.1:{free_port()}"
    monkeypatch.setenv(tracking.SWEEP, "0123456789abcdef")
    metrics = job.run(on_server(data, uri, prepared(tmp_path)))
    assert f"the results are kept in {tmp_path}" in caplog.text
    assert f"swg upload tracking.uri={uri} tracking.pending={tmp_path}" in caplog.text
    assert tracking.finished_runs(tracking.local_store(str(tmp_path)))["test_score"].tolist() == [metrics["test_score"]]
    tracking.close_sweep(tracking.server_store(uri), "0123456789abcdef")  # raises nothing


def test_a_job_stops_before_training_if_the_server_is_absent(data, tmp_path, monkeypatch):
    monkeypatch.setattr(zero_shot, "results", not_trained)
    uri = f"http://127.0.0.1:{free_port()}"
    with pytest.raises(tracking.StoreAway, match=f"no MLflow server answers at tracking.uri={uri}: start it"):
        job.run(on_server(data, uri, tmp_path))


def whole(store, run_id):
    """Parameters, tags, and all else that there is to a run."""
    client, run = store.client, store.client.get_run(run_id)
    metrics = {name: [dict(each) for each in client.get_metric_history(run_id, name)] for name in run.data.metrics}
    times = (run.info.status, run.info.start_time, run.info.end_time, run.info.run_name)
    with tempfile.TemporaryDirectory() as folder:
        kept = Path(client.download_artifacts(run_id, "", folder))
        files = {str(path.relative_to(kept)): path.read_bytes() for path in kept.rglob("*") if path.is_file()}
    return run.data.params, run.data.tags, (metrics, times, files)


def killed_upload(uri, pending):
    """Die at the last moment of the first run."""
    from mlflow import MlflowClient

    MlflowClient.set_terminated = lambda *_, **__: os.kill(os.getpid(), signal.SIGKILL)
    tracking.upload(tracking.server_store(uri, pending=pending))


def test_runs_are_uploaded_whole_and_once(server, lost, monkeypatch):
    pending, _ = lost
    store, local = server.store(pending), tracking.local_store(str(pending))
    with monkeypatch.context() as patch:  # tracking=local, with a sweep of its own
        patch.setenv(tracking.SWEEP, tracking.open_sweep(local, "alone", "small"))
        keep(local, 3, study="alone")

    killed = PROCESSES.Process(target=killed_upload, args=(server.uri, str(pending)))
    killed.start()
    killed.join()
    assert killed.exitcode == -signal.SIGKILL
    assert tracking.finished_runs(store, study="trial").empty
    assert tracking.finished_runs(store, study="alone").empty

    assert tracking.upload(store) == 2
    for run_id in tracking.finished_runs(local)["run_id"]:
        params, tags, rest = whole(local, run_id)
        (copy,) = store.client.search_runs([store.experiment_id], f"tags.origin = '{tags['origin']}'")
        sweep = tracking.find_sweep(store, params["study"], "small")
        assert whole(store, copy.info.run_id) == (params, {**tags, "mlflow.parentRunId": sweep}, rest)
        assert store.client.get_run(sweep).info.status == "FINISHED"
        assert {"config.yaml"} < set(rest[-1])

    left_open = tracking.open_sweep(store, "alone", "small")  # by an upload that was killed before its last step
    before = len(store.client.search_runs([store.experiment_id]))
    assert tracking.upload(server.store(pending)) == 0
    assert len(store.client.search_runs([store.experiment_id])) == before
    assert store.client.get_run(left_open).info.status == "FINISHED"


def test_an_upload_of_nothing_is_an_error(tmp_path):
    server = tracking.server_store("http://host:1", pending=str(tmp_path))
    with pytest.raises(ValueError, match=f"no runs to upload to http://host:1 in {tmp_path}.*tracking.pending=FOLDER"):
        tracking.upload(server)
    assert tracking.local_store(str(prepared(tmp_path))).experiment_id
    with pytest.raises(ValueError, match=f"{tmp_path} has no finished run to upload: give another folder"):
        tracking.upload(server)


def test_a_missing_postgresql_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(postgresql, "DEBIAN", tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ValueError, match="apt-get install postgresql"), postgresql.database(tmp_path / "database"):
        pass


def test_another_process_is_not_taken_for_the_database(tmp_path):
    """After a power failure the number that PostgreSQL left may be that of anybody, such as of this process."""
    assert not postgresql._runs(tmp_path)
    (tmp_path / "postmaster.pid").write_text(f"{os.getpid()}\n{tmp_path}\n")
    assert not postgresql._runs(tmp_path)
    with subprocess.Popen(["sleep", "60"], cwd=tmp_path) as server:
        (tmp_path / "postmaster.pid").write_text(f"{server.pid}\n{tmp_path}\n")
        assert postgresql._runs(tmp_path)
        server.kill()


def test_a_folder_of_another_version_is_refused(tmp_path, monkeypatch):
    program = tmp_path / "15" / "bin" / "postgres"
    program.parent.mkdir(parents=True)
    program.write_text("#!/bin/sh\necho 'postgres (PostgreSQL) 15.14 (Debian 15.14-0+deb12u1)'\n")
    program.chmod(0o755)
    monkeypatch.setattr(postgresql, "DEBIAN", tmp_path)
    monkeypatch.setenv("PATH", "")
    (tmp_path / "PG_VERSION").write_text("13\n")
    with pytest.raises(ValueError, match="PostgreSQL 13, installed is 15: install postgresql-13"):
        postgresql.database(tmp_path).__enter__()
