"""MLflow behind a few functions: the store, the run of a job, the run of a sweep, and the query for finished runs."""

import fcntl
import logging
import os
import sqlite3
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

os.environ.setdefault("MLFLOW_DISABLE_TELEMETRY", "true")  # read when mlflow is imported
os.environ.setdefault("MLFLOW_HTTP_REQUEST_MAX_RETRIES", "2")  # an absent server is reported in seconds, not minutes
os.environ.setdefault("MLFLOW_HTTP_REQUEST_TIMEOUT", "20")  # [s]

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from mlflow import MlflowClient

EXPERIMENT = "strain wave gears"
SWEEP = "STRAIN_WAVE_GEARS_SWEEP"  # environment variable, which worker processes inherit: the run that jobs belong to


@dataclass(frozen=True)
class Store:
    """Where runs are kept.

    Attributes
    ----------
    uri : str
        Address for MLflow.
    experiment : str
        Name of the MLflow experiment that holds all runs.
    folder : Path or None
        Folder of a local store: its database and, beside it, the artifacts. None with a server.
    """

    uri: str
    experiment: str = EXPERIMENT
    folder: Path | None = None

    @cached_property
    def client(self) -> "MlflowClient":
        """The client of this store; the database of a local store is created when it does not exist.

        Two processes that create a database at the same time would destroy each other's, so they take turns.

        Raises
        ------
        ValueError
            If the server does not answer.
        """
        from mlflow import MlflowClient
        from mlflow.exceptions import MlflowException

        if self.folder is None:
            client = MlflowClient(tracking_uri=self.uri)
            try:
                client.get_experiment_by_name(self.experiment)
            except MlflowException as error:
                raise ValueError(
                    f"no MLflow server answers at tracking.uri={self.uri}: start it, correct the address, "
                    "or use tracking=local"
                ) from error
            return client
        self.folder.mkdir(parents=True, exist_ok=True)
        for chatty in ("alembic", "mlflow.store.db"):
            logging.getLogger(chatty).setLevel(logging.WARNING)
        with (self.folder / "creation.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            client = MlflowClient(tracking_uri=self.uri)
            client.search_experiments()
            if not client.get_experiment_by_name(self.experiment):
                client.create_experiment(self.experiment, artifact_location=(self.folder / "artifacts").as_uri())
            with closing(sqlite3.connect(self.folder / "mlflow.db")) as database:
                database.execute("pragma journal_mode=wal")  # readers and writers do not wait for each other
        return client

    @cached_property
    def experiment_id(self) -> str:
        """Number of the experiment, which is created when it does not exist."""
        found = self.client.get_experiment_by_name(self.experiment)
        return str(found.experiment_id if found else self.client.create_experiment(self.experiment))


def local_store(folder: str, experiment: str = EXPERIMENT) -> Store:
    """A store in a folder of this machine: an SQLite database with the artifacts beside it."""
    path = Path(folder).resolve()
    return Store(f"sqlite:///{path / 'mlflow.db'}", experiment, path)


def server_store(uri: str, experiment: str = EXPERIMENT) -> Store:
    """A store behind an MLflow server.

    Raises
    ------
    ValueError
        If the address is not one of a server.
    """
    if not uri.startswith(("http://", "https://")):
        raise ValueError(
            f"tracking.uri={uri!r} is no address of a server: give one like http://host:5000, or tracking=local"
        )
    return Store(uri, experiment)


class Run:
    """A run in progress, to be filled once with all there is to say."""

    def __init__(self, store: Store, run_id: str) -> None:
        self._client, self._id = store.client, run_id

    def record(
        self, metrics: Mapping[str, float], figures: Mapping[str, "Figure"], tables: Mapping[str, pd.DataFrame]
    ) -> None:
        """Keep the metrics in one transaction; figures and tables (Parquet) under their path among the artifacts."""
        from mlflow.entities import Metric

        now = int(1000 * time.time())
        self._client.log_batch(self._id, metrics=[Metric(name, value, now, 0) for name, value in metrics.items()])
        for path, figure in figures.items():
            self._client.log_figure(self._id, figure, path)
        with tempfile.TemporaryDirectory() as folder:
            for path, table in tables.items():
                file = Path(folder) / Path(path).name
                table.to_parquet(file)
                self._client.log_artifact(self._id, str(file), str(Path(path).parent))


@contextmanager
def job_run(
    store: Store, name: str, key: str, parameters: Mapping[str, Any], config: Mapping[str, Any], tags: Mapping[str, str]
) -> Iterator[Run]:
    """The run of one job: finished at the end, failed after an exception, and left running by a killed job.

    It is a child of the run that the environment variable ``SWEEP`` names; a job outside a sweep has no parent.

    Parameters
    ----------
    store : Store
    name : str
        Name of the run.
    key : str
        What :func:`finished_metrics` finds it by.
    parameters : mapping
        Parameters by which the run is looked up and compared.
    config : mapping
        Resolved configuration, kept as ``config.yaml``.
    tags : mapping
        Further facts.
    """
    from mlflow.entities import Param

    parent = os.environ.get(SWEEP)
    everything = {"kind": "job", "key": key, **tags, **({"mlflow.parentRunId": parent} if parent else {})}
    run_id = store.client.create_run(store.experiment_id, tags=everything, run_name=name).info.run_id
    try:
        store.client.log_batch(run_id, params=[Param(name, str(value)) for name, value in parameters.items()])
        store.client.log_dict(run_id, dict(config), "config.yaml")
        yield Run(store, run_id)
    except BaseException:
        store.client.set_terminated(run_id, "FAILED")
        raise
    store.client.set_terminated(run_id)


def finished_metrics(store: Store, key: str) -> dict[str, float] | None:
    """The metrics of a finished job, or None if there is none with this key."""
    runs = store.client.search_runs(
        [store.experiment_id], f"tags.kind = 'job' and tags.key = '{key}' and attributes.status = 'FINISHED'"
    )
    return dict(runs[0].data.metrics) if runs else None


def open_sweep(store: Store, study: str, grid: str) -> str:
    """Open the run that the jobs of a study on a grid belong to, for ever the same one, and return its id."""
    sweep = {"kind": "sweep", "study": study, "grid": grid}
    query = " and ".join(f"tags.{name} = '{value}'" for name, value in sweep.items())
    found = store.client.search_runs([store.experiment_id], query, order_by=["attributes.start_time DESC"])
    if not found:
        return str(store.client.create_run(store.experiment_id, tags=sweep, run_name=f"{study} {grid}").info.run_id)
    run_id = str(found[0].info.run_id)
    store.client.update_run(run_id, "RUNNING")
    return run_id


def close_sweep(store: Store, run_id: str) -> None:
    """Mark the run of a sweep as finished; jobs of another sweep of the same study may still join it."""
    store.client.set_terminated(run_id)


def finished_runs(store: Store, **parameters: str) -> pd.DataFrame:
    """The newest finished run of every configuration, one row each, newest first.

    Parameters
    ----------
    store : Store
    **parameters : str
        Values that parameters must have, such as ``grid="paper"``.

    Returns
    -------
    DataFrame
        Columns are the parameters (text), the metrics (numbers), ``data_digest``, ``code_version`` (empty where a run
        has none) and ``run_id``; empty if there is no run.
    """
    conditions = [f"params.{name} = '{value}'" for name, value in parameters.items()]
    query = " and ".join(["tags.kind = 'job'", "attributes.status = 'FINISHED'", *conditions])
    runs = store.client.search_runs(
        [store.experiment_id], query, max_results=50_000, order_by=["attributes.start_time DESC"]
    )
    newest: dict[tuple[tuple[str, str], ...], Any] = {}
    for run in runs:
        newest.setdefault(tuple(sorted(run.data.params.items())), run)
    return pd.DataFrame(
        [
            {
                **r.data.params, **r.data.metrics, "data_digest": r.data.tags["data_digest"],
                "code_version": r.data.tags.get("code_version", ""), "run_id": r.info.run_id,
            }
            for r in newest.values()
        ]
    )  # fmt: skip


def table_of(store: Store, run_id: str, path: str) -> pd.DataFrame:
    """A table that a run keeps among its artifacts."""
    with tempfile.TemporaryDirectory() as folder:
        return pd.read_parquet(store.client.download_artifacts(run_id, path, folder))
