"""Where runs are kept: a folder of this machine, or a server."""

import logging
import sqlite3
from contextlib import closing
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from swgsim.common.files import make_folder, replacing, sole_maker

if TYPE_CHECKING:
    from mlflow import MlflowClient

EXPERIMENT = "strain wave gears"
DATABASE = "mlflow.db"
PATIENCE = (5, 20)  # seconds until a server accepts a connection, and until it answers


class StoreAway(ValueError):
    """No run can be kept: no MLflow server answers, or a folder takes no runs. The message has the remedy."""


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
    option : str
        The choice that names the folder of a local store.
    """

    uri: str
    experiment: str = EXPERIMENT
    folder: Path | None = None
    pending: "Store | None" = None
    option: str = "tracking.folder"

    @cached_property
    def client(self) -> "MlflowClient":
        """The client of this store; the database of a local store is created when it does not exist.

        Raises
        ------
        StoreAway
            If the server does not answer, or the folder takes no runs.
        """
        from mlflow.exceptions import MlflowException

        if self.folder is None:
            return _server_client(self.uri, self.experiment)
        try:
            return self._folder_client(self.folder)
        except (OSError, sqlite3.Error, MlflowException) as error:
            raise self.away(error) from error

    def _folder_client(self, folder: Path) -> "MlflowClient":
        """Two processes that create a database at the same time would destroy each other's, so they take turns."""
        from mlflow import MlflowClient

        make_folder(folder)
        artifacts = folder / "artifacts"
        self._require_same_for_mlflow(artifacts)
        for chatty in ("alembic", "mlflow.store.db"):
            logging.getLogger(chatty).setLevel(logging.WARNING)
        with sole_maker(folder / DATABASE, wait=True):
            if not self.exists:
                _create(folder / DATABASE)
            client = MlflowClient(tracking_uri=self.uri)
            if not client.get_experiment_by_name(self.experiment):
                client.create_experiment(self.experiment, artifact_location=artifacts.as_uri())
            with closing(sqlite3.connect(folder / DATABASE)) as database:
                database.execute("pragma journal_mode=wal")  # readers and writers do not wait for each other
        return client

    def _require_same_for_mlflow(self, artifacts: Path) -> None:
        """Raise unless MLflow opens the same folder: it reads addresses as UTF-8, whatever the locale says of names."""
        from mlflow.utils.file_utils import local_file_uri_to_path

        if Path(local_file_uri_to_path(artifacts.as_uri())) != artifacts:
            raise self.away(
                ValueError(
                    f"in this locale its name reads {str(artifacts.parent)!r}, for MLflow as UTF-8 it is another: "
                    "start with PYTHONUTF8=1, or choose a name in ASCII"
                )
            )

    def away(self, error: Exception) -> StoreAway:
        """The error for a folder that takes no runs."""
        return StoreAway(f"{self.folder} takes no runs; give {self.option}=FOLDER ({str(error)[:300]})")

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
    kept = replace(local_store(pending, experiment), option="tracking.pending") if pending else None
    return Store(uri.rstrip("/"), experiment, pending=kept)


def lost() -> tuple[type[Exception], ...]:
    """The exceptions that show that a server has gone away, or that a folder takes no more."""
    from mlflow.exceptions import MlflowException

    return MlflowException, OSError, StoreAway


def _server_client(uri: str, experiment: str) -> "MlflowClient":
    import requests
    from mlflow import MlflowClient
    from mlflow.exceptions import MlflowException

    client = MlflowClient(tracking_uri=uri)
    try:
        requests.head(uri, timeout=PATIENCE)  # MLflow itself would try for a minute
        client.get_experiment_by_name(experiment)
    except (MlflowException, requests.RequestException) as error:
        raise StoreAway(
            f"no MLflow server answers at tracking.uri={uri}: start it, name it in its allowed_hosts, correct the "
            f"address, or use tracking=local ({str(error)[:300]})"
        ) from error
    return client
