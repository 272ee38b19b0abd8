"""A folder that takes no runs: a written answer is not lost, a job stops before it works, and the remedy is named."""

import errno
import fcntl
import importlib.util
import os
import sys

import pytest
from mlflow.exceptions import MlflowException
from prepared_store import store_in

from learn import tracking
from learn.commands import close_loop
from learn.tracking.job_run import Results
from swgsim.common import files
from swgsim.common.outcome import Outcome

ERRORS = {when: {what: 1.0 for what in ("recordings",)} for when in ("before", "after")}
REPORT = {"verdict": "nothing_missing", "sentence": "Nothing is missing.", "effects": [], "seconds": 1.0}
OUTCOME = Outcome({**REPORT, "error": {**ERRORS, "noise_floor": 0.5}}, {}, "digest")
CONFIG = {"recordings": "bench", "commissioning": None, "seed": 0, "source": None, "out": "answer"}


def no_locks(monkeypatch):
    def refuse(*_):
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr(fcntl, "flock", refuse)


@pytest.fixture(params=["no locks", "a file"])
def refusing(request, tmp_path, monkeypatch):
    """A folder that takes no runs, and the cause that is named."""
    folder = tmp_path / "runs"
    if request.param == "no locks":
        no_locks(monkeypatch)
        return folder, "No locks available"
    folder.write_text("")
    return folder, "choose another folder"


def test_an_answer_whose_run_cannot_be_kept_is_named_with_a_remedy_and_the_command_ends_normally(refusing, caplog):
    folder, cause = refusing
    close_loop.record({**CONFIG, "tracking": {"name": "local", "folder": str(folder)}}, OUTCOME)
    (said,) = caplog.messages
    assert said.startswith(
        f"the answer is in answer; its run could not be kept: {folder} takes no runs; give tracking.folder=FOLDER ("
    )
    assert cause in said


def test_the_remedy_for_runs_that_wait_for_a_server_is_their_own_folder(refusing, caplog):
    folder, cause = refusing
    server = {"name": "server", "uri": "http://127.0.0.1:9", "pending": str(folder)}
    close_loop.record({**CONFIG, "tracking": server}, OUTCOME)
    assert "give tracking.pending=FOLDER" in caplog.messages[-1]
    assert cause in caplog.messages[-1]


def test_a_job_is_refused_before_it_works(refusing):
    folder, cause = refusing
    store = tracking.local_store(str(folder))
    with pytest.raises(tracking.StoreAway, match=f"give tracking.folder=FOLDER .*{cause}"):
        tracking.finished_metrics(store, "key")
    with pytest.raises(ValueError, match="takes no runs"):  # the kind of error with which a sweep stops at its start
        tracking.open_sweep(store, "study", "grid")


@pytest.mark.parametrize(
    ("error", "raised"),
    [
        (OSError(errno.ENOSPC, "No space left on device"), tracking.StoreAway),
        (MlflowException("database or disk is full"), tracking.StoreAway),
        (
            MlflowException.invalid_parameter_value("a wrong name"),
            MlflowException,
        ),  # a defect, for which no folder helps
    ],
    ids=["disk", "database", "defect"],
)
def test_a_folder_that_takes_no_more_when_the_job_ends_is_named(error, raised, tmp_path, monkeypatch):
    def write(*_):
        raise error

    monkeypatch.setattr(Results, "write", write)
    with pytest.raises(raised) as ended, tracking.job_run(store_in(tmp_path), "run", "key", {}, {}, {}):
        pass
    assert error in (ended.value, ended.value.__cause__)


def test_an_error_of_the_job_itself_is_not_one_of_its_store(tmp_path):
    with pytest.raises(FileNotFoundError, match="data"), tracking.job_run(store_in(tmp_path), "run", "key", {}, {}, {}):
        raise FileNotFoundError("data")


def test_a_folder_that_mlflow_would_open_elsewhere_is_refused(tmp_path):
    """A name in ISO 8859-1 below UTF-8; the other way round is the same for MLflow, which reads UTF-8 always."""
    folder = tmp_path / os.fsdecode(b"Pr\xfcfstand")
    try:
        folder.mkdir()
    except OSError:
        pytest.skip("this disk has names in UTF-8 only")
    with pytest.raises(tracking.StoreAway, match=r"takes no runs.*PYTHONUTF8=1"):
        _ = tracking.local_store(str(folder)).client
    assert not list(folder.iterdir())
    assert [path.name for path in tmp_path.iterdir()] == [folder.name]
    assert store_in(tmp_path / "Prüfstand").experiment_id


def test_a_system_without_the_locks_of_linux_and_macos_is_told_what_to_do(monkeypatch):
    monkeypatch.setitem(sys.modules, "fcntl", None)  # as on Windows
    spec = importlib.util.spec_from_file_location("files_on_windows", files.__file__)
    with pytest.raises(ImportError, match="Linux or macOS: on Windows run it in WSL"):
        spec.loader.exec_module(importlib.util.module_from_spec(spec))
