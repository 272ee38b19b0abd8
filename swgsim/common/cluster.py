"""Tasks on a Dask cluster whose workers have the code, libraries and folder of this process."""

import logging
import os
import platform
import socket
from collections.abc import Callable, Iterable, Iterator
from contextlib import chdir, contextmanager
from importlib import import_module
from importlib.metadata import version
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

from swgsim.common.version import code_version, subpackages

if TYPE_CHECKING:
    from distributed import Client, Future, Worker

PRESENCE = 10  # s, within which a scheduler answers and has a worker
ANSWER = 60  # s, within which all workers answer
REMEDY = "install this project there in the same version, and start it again"


class Place(NamedTuple):
    """Code and libraries of a process, on which results depend, and the folder in which it works."""

    installed: str
    folder: str


def own_place(further: Callable[[], str]) -> Place:
    """Place of this process; ``further`` gives the version of code besides this package."""
    libraries = ", ".join(f"{name} {version(name)}" for name in ("numpy", "scipy", "h5py"))
    code = code_version(*subpackages())
    installed = f"swgsim {code}, Python {platform.python_version()}, {libraries} {further()}"
    return Place(installed.rstrip(), os.getcwd())


def results(
    scheduler: str, function: Callable[..., Any], tasks: Iterable[tuple], further: Callable[[], str]
) -> Iterator[Any]:
    """Results of a function for every task; see :meth:`swgsim.common.compute.Engine.results`.

    Joblib's backend for Dask ignores workers that join later, and works alone if the cluster has one worker.
    """
    with _connected(scheduler, further) as client:
        from distributed import as_completed

        place, left = own_place(further), enumerate(tasks)
        numbers: dict[Any, int] = {}  # of the tasks that are submitted
        done: dict[int, Any] = {}

        def more() -> Iterator["Future"]:
            """Submit tasks until every worker of now has two; without a worker one task waits."""
            most = max(2 * len(client.ncores()) - len(numbers), 0 if numbers else 1)
            for number, task in islice(left, most):
                future = client.submit(task_of_another, place, further, function, task, pure=False)
                numbers[future.key] = number
                yield future

        running, next_number = as_completed(list(more()), loop=client.loop), 0
        for future in running:
            done[numbers.pop(future.key)] = future.result()
            running.update(list(more()))
            while next_number in done:
                yield done.pop(next_number)
                next_number += 1


@contextmanager
def _connected(scheduler: str, further: Callable[[], str]) -> Iterator["Client"]:
    """A client of the cluster; errors of Dask on an absent, unfit or lost cluster become one sentence.

    Raises
    ------
    ValueError
    """
    try:
        import dask
        from distributed import CancelledError, Client, KilledWorker
        from distributed.comm import CommClosedError
    except ImportError:
        raise ValueError("compute=dask needs Dask: pip install 'swg-workbench[dask]', or use compute=local") from None
    logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
    try:
        client = Client(scheduler, timeout=PRESENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ValueError(
            f"no Dask scheduler answers at scheduler={scheduler} ({error}): start it with 'dask scheduler', correct "
            "the address, or use compute=local"
        ) from None
    with client, dask.config.set({"distributed.admin.large-graph-warning-threshold": "1GiB"}):  # of the oracle's tasks
        _require_fit(client, scheduler, further)
        try:
            yield client
        except (CancelledError, CommClosedError):
            raise ValueError(
                f"the Dask scheduler at {scheduler} was lost; finished parts are kept: start it again, or use "
                "compute=local, and give the same command"
            ) from None
        except KilledWorker as error:
            raise ValueError(
                f"one task killed several workers of {scheduler}; it may need more memory: {error}"
            ) from None


def _require_fit(client: "Client", scheduler: str, further: Callable[[], str]) -> None:
    """Raise a ValueError unless the cluster has workers, and all of them and the scheduler can do the tasks.

    Dask would wait for ever without a worker, or if a worker or the scheduler could not import this package.
    """
    own = own_place(further)
    try:
        client.wait_for_workers(1, timeout=PRESENCE)
        client.sync(client.run_on_scheduler, import_module, __name__, callback_timeout=ANSWER)
        client.sync(client.run, import_module, __name__, callback_timeout=ANSWER)
        found = client.sync(client.run, _fitness, own.folder, further, callback_timeout=ANSWER)
    except TimeoutError:
        raise ValueError(
            f"{scheduler} has no worker, or one that does not answer within {ANSWER} s: start them with "
            f"'dask worker {scheduler} --nthreads 1'"
        ) from None
    except ImportError as error:
        raise ValueError(f"{scheduler} or a worker of it cannot import swgsim ({error}): {REMEDY}") from None
    for worker, (installed, sees_folder, threads) in found.items():
        _require_same(f"worker {worker} of {scheduler}", installed, own.installed)
        if not sees_folder:
            raise ValueError(f"worker {worker} of {scheduler} has no folder {own.folder}: work in one that all share")
        if threads > 1:
            raise ValueError(f"worker {worker} of {scheduler} has {threads} threads, must have 1: add --nthreads 1")


def _require_same(worker: str, installed: str, expected: str) -> None:
    if installed != expected:
        raise ValueError(f"{worker} has {installed}, must have {expected}: {REMEDY}")


def _fitness(folder: str, further: Callable[[], str], dask_worker: "Worker") -> tuple[str, bool, int]:
    """Code and libraries of a worker, whether it sees the folder, and its number of threads."""
    return own_place(further).installed, os.path.isdir(folder), dask_worker.state.nthreads


def task_of_another(place: Place, further: Callable[[], str], function: Callable[..., Any], task: tuple) -> Any:
    """Do a task on a worker in the folder of its place; a worker that joined late is checked here."""
    _require_same(f"a worker on {socket.gethostname()}", own_place(further).installed, place.installed)
    with chdir(place.folder):
        return function(*task)
