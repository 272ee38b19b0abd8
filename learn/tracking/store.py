"""Where runs are kept: a folder of this machine, or a server."""

import fcntl
import logging
import sqlite3
from contextlib import closing
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from swgsim.common.files import replacing

if TYPE_CHECKING:
    from mlflow import MlflowClient

EXPERIMENT = "strain wave gears"
DATABASE = "mlflow.db"
PATIENCE = (5, 20)  # seconds until a server accepts a connection, and until it answers


class ServerAway(ValueError):
    """No MLflow server answers."""


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
        Folder of a local store, with its database and artifacts. None with a server.
    pending : Store or None
        With a server, the local store of results that the server could not take.
    """

    uri: str
    experiment: str = EXPERIMENT
    folder: Path | None = None
    pending: "Store | None" = None

    @cached_property
    def client(self) -> "MlflowClient":
        """The client of this store; the database of a local store is created when it does not exist.

        Raises
        ------
        ServerAway
            If the server does not answer.
        """
        return _server_client(self.uri, self.experiment) if self.folder is None else self._folder_client(self.folder)

    def _folder_client(self, folder: Path) -> "MlflowClient":
        """Two processes that create a database at the same time would destroy each other's, so they take turns."""
        from mlflow import MlflowClient

        folder.mkdir(parents=True, exist_ok=True)
        for chatty in ("alembic", "mlflow.store.db"):
            logging.getLogger(chatty).setLevel(logging.WARNING)
        with (folder / "creation.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not self.exists:
                _create(folder / DATABASE)
            client = MlflowClient(tracking_uri=self.uri)
            if not client.get_experiment_by_name(self.experiment):
                client.create_experiment(self.experiment, artifact_location=(folder / "artifacts").as_uri())
            with closing(sqlite3.connect(folder / DATABASE)) as database:
                database.execute("pragma journal_mode=wal")  # readers and writers do not wait for each other
        return client

    @cached_property
    def experiment_id(self) -> str:
        """Number of the experiment, which is created when it does not exist."""
        from mlflow.exceptions import MlflowException

        found = self.client.get_experiment_by_name(self.experiment)
        if found:
            return str(found.experiment_id)
        try:
            return str(self.client.create_experiment(self.experiment))
        except MlflowException as error:  # of the jobs that start at the same time, one is the first
            if error.error_code != "RESOURCE_ALREADY_EXISTS":
                raise
        return str(self.client.get_experiment_by_name(self.experiment).experiment_id)

    @property
    def exists(self) -> bool:
        """Whether a local store has a database."""
        return self.folder is not None and (self.folder / DATABASE).is_file()


def _create(database: Path) -> None:
    """Create a database with its tables, complete or not at all: MLflow cannot use one whose creation was killed."""
    from mlflow import MlflowClient

    with replacing(database) as aside:
        for left in database.parent.glob(f"{aside.name}*"):  # by a killed process, with its journal
            left.unlink()
        MlflowClient(tracking_uri=f"sqlite:///{aside}").search_experiments()


def local_store(folder: str, experiment: str = EXPERIMENT) -> Store:
    """A store in a folder of this machine: an SQLite database and the artifacts."""
    path = Path(folder).resolve()
    return Store(f"sqlite:///{path / DATABASE}", experiment, path)


def server_store(uri: str, experiment: str = EXPERIMENT, pending: str | None = None) -> Store:
    """A store behind an MLflow server.

    Parameters
    ----------
    uri : str
        Address of the server.
    experiment : str
        Name of the experiment.
    pending : str or None
        Folder of the local store for results that the server could not take; None: such a job fails.

    Raises
    ------
    ValueError
        If the address is not one of a server.
    """
    if not uri.startswith(("http://", "https://")):
        raise ValueError(
            f"tracking.uri={uri!r} is not an address of a server: give one like http://host:5000, or tracking=local"
        )
    return Store(uri.rstrip("/"), experiment, pending=local_store(pending, experiment) if pending else None)


def lost() -> tuple[type[Exception], ...]:
    """The exceptions that show that a server has gone away."""
    from mlflow.exceptions import MlflowException

    return MlflowException, OSError, ServerAway


def _server_client(uri: str, experiment: str) -> "MlflowClient":
    import requests
    from mlflow import MlflowClient
    from mlflow.exceptions import MlflowException

    client = MlflowClient(tracking_uri=uri)
    try:
        requests.head(uri, timeout=PATIENCE)  # MLflow itself would try for a minute
        client.get_experiment_by_name(experiment)
    except (MlflowException, requests.RequestException) as error:
        raise ServerAway(
            f"no MLflow server answers at tracking.uri={uri}: start it, name it in its allowed_hosts, correct the "
            f"address, or use tracking=local ({str(error)[:300]})"
        ) from error
    return client
