"""Engines for many tasks: processes of this machine or a Dask cluster, with equal results.

Jobs keep the results of their tasks as files, so that an interrupted run resumes from them.
"""

import re
import signal
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from multiprocessing import resource_tracker
from typing import Any

import joblib

from swgsim.common import cluster
from swgsim.common.checks import require_known


@dataclass(frozen=True)
class Engine:
    """Processes of this machine or a Dask cluster that do tasks.

    Attributes
    ----------
    workers : int or None
        Number of processes of this machine; None for one per core.
    scheduler : str or None
        Address of a Dask scheduler; all its workers are used instead of this machine.
    """

    workers: int | None = None
    scheduler: str | None = None

    def __post_init__(self) -> None:
        address = self.scheduler
        if address is not None and not re.fullmatch(r"(tcp|tls)://\S+:\d+", address):
            raise ValueError(f"scheduler is {address!r}, must be an address such as tcp://127.0.0.1:8786")

    @classmethod
    def of(cls, config: Mapping[str, Any]) -> "Engine":
        """The engine of ``compute``, ``scheduler`` and ``workers`` of a configuration.

        Raises
        ------
        ValueError
            If a choice is unknown, or they contradict each other.
        """
        workers, compute, scheduler = config["workers"], config.get("compute", "local"), config.get("scheduler")
        if workers is not None and (not isinstance(workers, int) or isinstance(workers, bool) or workers < 1):
            raise ValueError(f"workers is {workers!r}, must be an integer from 1, or null for one per core")
        require_known("compute", [compute], ["local", "dask"])
        if (compute == "dask") != (scheduler is not None):
            raise ValueError(
                f"compute is {compute} and scheduler is {scheduler}: choose compute=dask with the address of a "
                "scheduler, such as scheduler=tcp://127.0.0.1:8786, or compute=local without one"
            )
        return cls(workers, scheduler and str(scheduler))

    def results(
        self, function: Callable[..., Any], tasks: Iterable[tuple], count: int, further: Callable[[], str] = str
    ) -> Iterator[Any]:
        """Yield the results of a function for all tasks, in order, as soon as they are ready.

        Parameters
        ----------
        function : callable
        tasks : iterable of tuple
            Arguments of the function; they are taken when workers become free.
        count : int
            Number of tasks.
        further : callable
            Returns the version of code besides this package; a worker with another version is refused.

        Raises
        ------
        ValueError
            If the cluster does not answer, is unfit or is lost; the message names address and remedy.
        """
        if self.scheduler is None:
            # Joblib warns when it replaces a worker that has grown by 300 MiB, and when it is interrupted.
            warnings.filterwarnings("ignore", "A worker stopped while some jobs were given", UserWarning)
            warnings.filterwarnings("ignore", ".*You could benefit from adjusting the input task iterator", UserWarning)
            pool = joblib.Parallel(min(self.workers or joblib.cpu_count(), max(count, 1)), return_as="generator")
            with ExitStack() as stack:
                with _interrupts_blocked_in_workers():
                    results = pool(joblib.delayed(function)(*task) for task in tasks)
                    stack.callback(results.close)
                yield from results
            return
        yield from cluster.results(self.scheduler, function, tasks, further)


@contextmanager
def _interrupts_blocked_in_workers() -> Iterator[None]:
    """Workers that start in this context ignore Ctrl-C; this process receives it and ends them.

    In a worker it would be lost in a destructor, or reported as an error while the worker starts.
    """
    resource_tracker.ensure_running()  # in Python 3.11 its start unblocks Ctrl-C
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
