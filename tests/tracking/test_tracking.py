"""Runs are kept, found again and shown."""

import json
import socket
import sqlite3
import time
from contextlib import closing

import pytest
from mlflow.exceptions import MlflowException

from learn import tracking
from learn.jobs import identity
from learn.tracking import ui as page

PARAMETERS = {"study": "table7", "grid": "small", "classifier": "rf"}


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    return tracking.local_store(str(tmp_path_factory.mktemp("store") / "runs"))


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
    store = tracking.local_store(str(tmp_path))
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


def test_sweeps_of_one_study_at_once_share_a_run_that_keeps_their_jobs_after_one_has_closed_it(store, monkeypatch):
    first, second = (tracking.open_sweep(store, "table9", "small") for _ in range(2))
    assert first == second
    monkeypatch.setenv(tracking.SWEEP, first)
    keep(store, "early", {"test_score": 5.0}, study="table9")
    tracking.close_sweep(store, first)
    assert store.client.get_run(first).info.status == "FINISHED"
    keep(store, "late", {"test_score": 5.0}, study="table9")
    assert parent(store, "early") == parent(store, "late") == first
    assert tracking.open_sweep(store, "table9", "small") == first
    assert store.client.get_run(first).info.status == "RUNNING"


def test_a_study_has_a_sweep_for_each_grid(store):
    sweeps = {grid: tracking.open_sweep(store, "table8", grid) for grid in ("small", "paper")}
    assert {store.client.get_run(run_id).info.run_name for run_id in sweeps.values()} == {
        "table8 small",
        "table8 paper",
    }


def test_a_single_job_has_no_parent(store):
    tracking.open_sweep(store, "table10", "small")
    keep(store, "single", {"test_score": 5.0}, study="table10")
    assert parent(store, "single") is None


def test_an_absent_server_is_reported_soon_with_the_remedy():
    with socket.socket() as unused:  # bound, but nobody listens
        unused.bind(("127.0.0.1", 0))
        uri = f"http://127.0.0.1:{unused.getsockname()[1]}"
        start = time.monotonic()
        with pytest.raises(ValueError, match=f"{uri}: start it.*tracking=local"):
            tracking.finished_metrics(tracking.server_store(uri), "key")
    assert time.monotonic() - start < 15


def test_database_lets_readers_and_writers_work_side_by_side(store):
    assert store.experiment_id
    with closing(sqlite3.connect(store.folder / "mlflow.db")) as database:
        assert database.execute("pragma journal_mode").fetchone() == ("wal",)


def test_artifacts_lie_beside_the_database(store):
    experiment = store.client.get_experiment(store.experiment_id)
    assert experiment.artifact_location == (store.folder / "artifacts").as_uri()


def test_saved_views_are_written_as_mlflow_reads_them(store):
    page.save_views(store)
    tags = store.client.get_experiment(store.experiment_id).tags
    saved = json.loads(tags["mlflow.sharedViewState.scores"])
    assert saved["name"] == "Scores"
    assert saved["state"].startswith("deflate;")
    table = page.decode(saved["state"])
    assert "metrics.`test_score`" in table["selectedColumns"]
    assert "params.`classifier`" in table["selectedColumns"]


def test_the_table_of_scores_does_not_mix_grids(store):
    for grid in ("paper", "sampled"):
        keep(store, f"on {grid}", {"test_score": 4.0}, grid=grid)

    def grids(view):
        return {run.data.params["grid"] for run in store.client.search_runs([store.experiment_id], view.filter)}

    assert grids(page.SCORES) == {"paper"}
    assert grids(page.OTHER_GRIDS) >= {"sampled"}
    assert "paper" not in grids(page.OTHER_GRIDS)


def test_the_installed_mlflow_knows_saved_views():
    from importlib.resources import files

    scripts = (files("mlflow") / "server" / "js" / "build" / "static" / "js").iterdir()
    text = "".join(
        s.read_text(encoding="utf-8") for s in scripts if s.name.startswith("main") and s.name.endswith(".js")
    )
    for word in ("mlflow.sharedViewState.", "viewStateShareKey", "deflate;", "selectedColumns", "searchFilter"):
        assert word in text


def test_link_names_the_view(store):
    assert page.link(store, "http://host:1").endswith("workflowType=machine_learning&viewStateShareKey=scores")


def test_key_depends_on_what_decides_the_result_only():
    config = {"seed": 0, "classifier": {"name": "rf"}, "data": "data", "tracking": {"name": "local"}}
    key = identity.job_key(config, "digest")
    assert len(key) == 16
    assert identity.job_key({**config, "data": "elsewhere", "tracking": {"name": "server"}}, "digest") == key
    assert identity.job_key({**config, "seed": 1}, "digest") != key
    assert identity.job_key(config, "another digest") != key


def test_what_has_runs_has_a_link(tmp_path, monkeypatch, capsys):
    store, loop, empty = (tracking.local_store(str(tmp_path), name) for name in (tracking.EXPERIMENT, "loop", "empty"))
    assert empty.experiment_id
    monkeypatch.setattr(page, "run_mlflow", lambda *_: None)
    page.serve(store, "host", 1)
    assert capsys.readouterr().out.startswith("No runs yet")
    keep(loop, "key", {"noise_floor": 0.8})
    page.serve(store, "host", 1)
    beside = f"http://host:1/#/experiments/{loop.experiment_id}/runs?workflowType=machine_learning"
    assert capsys.readouterr().out.splitlines() == [f"Experiment loop: {beside}"]
    assert page.others(loop, "http://host:1") == {}
    keep(store, "key", {"test_score": 4.0}, grid="paper")
    page.serve(store, "host", 1)
    *views, last = capsys.readouterr().out.splitlines()
    assert [line.partition(":")[0] for line in views] == ["Scores", "Sweeps"]
    assert last == f"Experiment loop: {beside}"
