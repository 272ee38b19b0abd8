"""The server of a team: MLflow in front of PostgreSQL, all of it in one folder."""

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from learn.tracking.postgresql import database
from swgsim.common.files import sole_maker

SECONDS_TO_STOP = 20


def serve_team(folder: Path, host: str, port: int, workers: int, allowed_hosts: str | None) -> None:
    """Serve runs and their artifacts until interrupted or terminated; what is in the folder stays for the next start.

    Parameters
    ----------
    folder : Path
        Of the database and the artifacts.
    host, port : str, int
        Where MLflow listens.
    workers : int
        Processes that answer.
    allowed_hosts : str or None
        Names under which others reach the server, as MLflow's option of this name; None: this machine and private
        addresses.

    Raises
    ------
    ValueError
        If the folder is served already, the port is taken, or PostgreSQL is not there in the version that it takes.
    RuntimeError
        If PostgreSQL does not start.
    """
    folder = folder.resolve()
    artifacts = folder / "artifacts"
    options = ["--workers", str(workers), "--serve-artifacts", "--artifacts-destination", str(artifacts)]
    options += ["--allowed-hosts", allowed_hosts] if allowed_hosts else []
    with until_stopped(), ExitStack() as stack:
        try:
            stack.enter_context(sole_maker(folder / "server"))
        except RuntimeError as error:
            raise ValueError(
                f"{folder} has a server already: use that one, or another folder with folder=..."
            ) from error
        artifacts.mkdir(mode=0o700, exist_ok=True)
        require_free(host, port)
        uri = stack.enter_context(database(folder / "database"))
        print(f"jobs join with: tracking=server tracking.uri=http://{host}:{port}", flush=True)
        run_mlflow(uri, host, port, *options)


def require_free(host: str, port: int) -> None:
    """Raise ValueError if something listens at a port."""
    with socket.socket() as trial:
        trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            trial.bind((host, port))
        except OSError as error:
            raise ValueError(f"cannot listen at {host}:{port} ({error.strerror}): choose another port=...") from error


@contextmanager
def until_stopped() -> Iterator[None]:
    """End the context quietly, with all that belongs to it, at Ctrl-C or when this process is terminated."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with suppress(KeyboardInterrupt):
        yield


def run_mlflow(uri: str, host: str, port: int, *options: str) -> None:
    """Run MLflow's server for a database until this process is interrupted.

    Raises
    ------
    RuntimeError
        If it ends by itself.
    """
    command = [sys.executable, "-m", "mlflow", "server", "--host", host, "--port", str(port), *options]
    environment = {**os.environ, "MLFLOW_SERVER_ENABLE_JOB_EXECUTION": "false"}  # which takes seven more processes
    process = subprocess.Popen([*command, "--backend-store-uri", uri], env=environment, start_new_session=True)
    try:
        raise RuntimeError(f"MLflow's server ended by itself with status {process.wait()}")
    finally:
        _stop(process)


def _stop(process: subprocess.Popen) -> None:
    """End a process and all that it has started."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGTERM)
        try:
            process.wait(SECONDS_TO_STOP)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
