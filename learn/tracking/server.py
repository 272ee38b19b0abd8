"""MLflow's server: started, awaited and stopped; for a team, in front of PostgreSQL and all in one folder."""

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import requests

from learn.tracking.postgresql import database
from swgsim.common.files import sole_maker

SECONDS_TO_STOP = 20
SECONDS_BETWEEN_TRIALS = 0.2
EVERY_ADDRESS = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}  # where a server that listens everywhere is reached


def serve_team(folder: Path, host: str, port: int | str, workers: int, allowed_hosts: str | None) -> None:
    """Serve runs and their artifacts until interrupted or terminated; the folder keeps them for the next start.

    Parameters
    ----------
    folder : Path
        Of the database and the artifacts.
    host : str
        Address at which MLflow listens.
    port : int or str
        Port at which MLflow listens.
    workers : int
        Number of processes that answer.
    allowed_hosts : str or None
        Names under which others reach the server, as MLflow's option of this name; None: this machine and private
        addresses.

    Raises
    ------
    ValueError
        If the port is not a number from 1 to 65535 or is in use, another process serves the folder, or PostgreSQL is
        not installed in the version of the folder.
    RuntimeError
        If PostgreSQL or MLflow does not start.
    """
    number = free_port(host, port)
    folder = folder.resolve()
    artifacts = folder / "artifacts"
    options = ["--workers", str(workers), "--serve-artifacts", "--artifacts-destination", str(artifacts)]
    options += ["--allowed-hosts", allowed_hosts] if allowed_hosts else []

    def ready() -> None:
        print(f"jobs join with: tracking=server tracking.uri=http://{host}:{number}", flush=True)

    with until_stopped(), ExitStack() as stack:
        try:
            stack.enter_context(sole_maker(folder / "server"))
        except RuntimeError as error:
            raise ValueError(
                f"another server serves {folder}: use it, or take another folder with folder=..."
            ) from error
        artifacts.mkdir(mode=0o700, exist_ok=True)
        uri = stack.enter_context(database(folder / "database"))
        run_mlflow(uri, host, number, *options, ready=ready)


def free_port(host: str, port: int | str) -> int:
    """The number of a port at which nothing listens.

    Raises
    ------
    ValueError
        If the port is not a number from 1 to 65535, or this process cannot listen there.
    """
    text = str(port)
    if not (text.isdecimal() and 1 <= int(text) <= 65535):
        raise ValueError(f"port={text} is not a number from 1 to 65535: give one, such as port=5051")
    with socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET) as trial:
        trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            trial.bind((host, int(text)))
        except OSError as error:
            other = int(text) % 65535 + 1
            raise ValueError(
                f"cannot listen at {host}:{text} ({error.strerror}): choose another port, such as port={other}"
            ) from error
    return int(text)


@contextmanager
def until_stopped() -> Iterator[None]:
    """End the context without an error at Ctrl-C, or when this process is terminated."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with suppress(KeyboardInterrupt):
        yield


def run_mlflow(uri: str, host: str, port: int, *options: str, ready: Callable[[], None]) -> None:
    """Run MLflow's server for a database until this process is interrupted.

    Parameters
    ----------
    uri : str
        Address of the database.
    host : str
    port : int
    *options : str
        Further options of ``mlflow server``.
    ready : callable
        Called once, when the server answers.

    Raises
    ------
    RuntimeError
        If the server ends by itself.
    """
    command = [sys.executable, "-m", "mlflow", "server", "--host", host, "--port", str(port), *options]
    environment = {**os.environ, "MLFLOW_SERVER_ENABLE_JOB_EXECUTION": "false"}  # which takes seven more processes
    process = subprocess.Popen([*command, "--backend-store-uri", uri], env=environment, start_new_session=True)
    try:
        while process.poll() is None and not _answers(EVERY_ADDRESS.get(host, host), port):
            time.sleep(SECONDS_BETWEEN_TRIALS)
        if process.poll() is None:
            ready()
        raise RuntimeError(f"MLflow's server ended by itself with status {process.wait()}")
    finally:
        _stop(process)


def _answers(host: str, port: int) -> bool:
    try:
        return requests.get(f"http://{host}:{port}/health", timeout=5).ok
    except requests.RequestException:
        return False


def _stop(process: subprocess.Popen) -> None:
    """End a process and all processes that it has started."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGTERM)
        try:
            process.wait(SECONDS_TO_STOP)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
