"""Runs are kept, found again and shown."""

import socket
import sqlite3
import time
from contextlib import closing

import pytest
from mlflow.exceptions import MlflowException
from prepared_store import prepared, store_in

from learn import tracking
from learn.jobs import identity
from learn.tracking import server, ui

PARAMETERS = {"study": "table7", "grid": "small", "classifier": "rf"}


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    return store_in(tmp_path_factory.mktemp("store") / "runs")


def keep(store, key, metrics, **parameters):
    values = {**PARAMETERS, **parameters}
    with tracking.job_run(store, key, key, values, {"seed": 0}, {"data_digest": "d"}) as run:
        run.record(metrics, {}, {})


def test_a_finished_job_is_found_by_its_key_a_failed_or_killed_one_is_not(store):
    keep(store, "good", {"test_score": 99.5})
    with pytest.raises(ZeroDivisionError), tracking.job_run(store, "bad", "bad", PARAMETERS, {}, {}):
        1 / 0  # noqa: B018
    assert tracking.finished_metrics(store, "good") == {"test_score": 99.5}
    assert tracking.finished_metrics(store, "bad") is None
    store.client.create_run(store.experiment_id, tags={"kind": "job", "key": "killed"})  # stays running
    assert tracking.finished_metrics(store, "killed") is None
    assert tracking.finished_metrics(store, "other") is None


def test_a_local_store_that_is_damaged_is_not_taken_for_a_lost_server(tmp_path, monkeypatch):
    store = store_in(tmp_path)
    monkeypatch.setenv(tracking.SWEEP, tracking.open_sweep(store, "trial", "small"))
    with closing(sqlite3.connect(store.folder / "mlflow.db")) as database:
        database.execute("drop table tags")
    with pytest.raises(MlflowException, match="no such table"):
        tracking.finished_metrics(store, "key")


def test_the_newest_run_of_a_configuration_comes_first_and_alone(store):
    keep(store, "old", {"test_score": 1.0}, grid="paper")
    keep(store, "new", {"test_score": 2.0}, grid="paper")
    keep(store, "knn", {"test_score": 3.0}, grid="paper", classifier="knn")
    runs = tracking.finished_runs(store, grid="paper")
    assert runs[["classifier", "test_score"]].to_numpy().tolist() == [["knn", 3.0], ["rf", 2.0]]
    assert tracking.finished_runs(store, grid="sampled").empty


def parent(store, key):
    (run,) = store.client.search_runs([store.experiment_id], f"tags.key = '{key}'")
    return run.data.tags.get("mlflow.parentRunId")


def test_sweeps_of_one_study_and_grid_share_a_run_that_keeps_their_jobs_after_one_has_closed_it(store, monkeypatch):
    first, second, other = (tracking.open_sweep(store, "table9", grid) for grid in ("small", "small", "paper"))
    assert first == second != other
    names = [store.client.get_run(run_id).info.run_name for run_id in (first, other)]
    assert names == ["table9 small", "table9 paper"]
    keep(store, "single", {"test_score": 5.0}, study="table9")
    assert parent(store, "single") is None
    monkeypatch.setenv(tracking.SWEEP, first)
    keep(store, "early", {"test_score": 5.0}, study="table9")
    tracking.close_sweep(store, first)
    assert store.client.get_run(first).info.status == "FINISHED"
    keep(store, "late", {"test_score": 5.0}, study="table9")
    assert parent(store, "early") == parent(store, "late") == first
    assert tracking.open_sweep(store, "table9", "small") == first
    assert store.client.get_run(first).info.status == "RUNNING"


def test_an_absent_server_is_reported_soon_with_the_remedy():
    with socket.socket() as unused:  # bound, but nobody listens
        unused.bind(("127.0.0.1", 0))
        uri = f"http://127.0.0.1:{unused.getsockname()[1]}"
        start = time.monotonic()
        with pytest.raises(ValueError, match=f"{uri}: start it.*tracking=local"):
            tracking.finished_metrics(tracking.server_store(uri), "key")
    assert time.monotonic() - start < 15


def test_the_database_lets_readers_and_writers_work_at_the_same_time_and_has_its_artifacts_in_its_folder(store):
    experiment = store.client.get_experiment(store.experiment_id)
    assert experiment.artifact_location == (store.folder / "artifacts").as_uri()
    with closing(sqlite3.connect(store.folder / "mlflow.db")) as database:
        assert database.execute("pragma journal_mode").fetchone() == ("wal",)


def test_key_depends_on_what_decides_the_result_only():
    config = {"seed": 0, "classifier": {"name": "rf"}, "data": "data", "tracking": {"name": "local"}}
    key = identity.job_key(config, "digest")
    assert len(key) == 16
    assert identity.job_key({**config, "data": "elsewhere", "tracking": {"name": "server"}}, "digest") == key
    assert identity.job_key({**config, "seed": 1}, "digest") != key
    assert identity.job_key(config, "another digest") != key


def test_every_experiment_with_runs_has_a_link(tmp_path):
    store, loop, empty = (
        tracking.local_store(str(prepared(tmp_path)), name) for name in (tracking.EXPERIMENT, "loop", "empty")
    )
    assert empty.experiment_id
    assert ui.links(store, "http://host:1") == {}
    keep(loop, "key", {"noise_floor": 0.8})
    assert ui.links(store, "http://host:1") == {"loop": f"http://host:1/#/experiments/{loop.experiment_id}/runs"}
    keep(store, "key", {"test_score": 4.0})
    assert set(ui.links(store, "http://host:1")) == {tracking.EXPERIMENT, "loop"}


def test_links_are_printed_once_the_server_answers(store, monkeypatch, capsys):
    keep(store, "shown", {"test_score": 5.0})
    answers = iter([False, False, True])
    printed = []

    def answered(host, port):
        printed.append(capsys.readouterr().out)
        return next(answers)

    monkeypatch.setattr(server, "_answers", answered)
    monkeypatch.setattr(server.sys, "executable", "/bin/sleep")  # in place of MLflow; it refuses the options
    monkeypatch.setattr(server.subprocess.Popen, "poll", lambda _: None)
    with pytest.raises(RuntimeError, match="ended by itself with status 1"):
        ui.serve(store, "127.0.0.1", free_number())
    assert printed == ["", "", ""]
    assert f"{tracking.EXPERIMENT}: http://127.0.0.1:" in capsys.readouterr().out


def free_number():
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return trial.getsockname()[1]


@pytest.mark.parametrize("port", ["banana", "0", 65536, 1.5, "taken"])
def test_a_port_that_cannot_be_used_is_refused_before_the_store_is_made(port, tmp_path, capsys):
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        listening.listen()
        port = listening.getsockname()[1] if port == "taken" else port
        message = rf"(port={port} is not a number|cannot listen at 127.0.0.1:{port}).*, such as port=\d+$"
        with pytest.raises(ValueError, match=message):
            ui.serve(tracking.local_store(str(tmp_path / "runs")), "127.0.0.1", str(port))
    assert not list(tmp_path.iterdir())
    assert not capsys.readouterr().out
