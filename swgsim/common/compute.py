"""Where tasks are worked off: by processes of this machine, or by a Dask cluster; the results are the same.

Every job hands out its tasks here, and keeps what they give as files, so that a run that breaks off goes on from them.
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
    """What works off tasks.

    Attributes
    ----------
    workers : int or None
        Processes of this machine; None: one per core.
    scheduler : str or None
        Address of a Dask scheduler, all of whose workers are used instead of this machine.
    """

    workers: int | None = None
    scheduler: str | None = None

    def __post_init__(self) -> None:
        address = self.scheduler
        if address is not None and not re.fullmatch(r"(tcp|tls)://\S+:\d+", address):
            raise ValueError(f"scheduler is {address!r}, must be an address such as tcp://127.0.0.1:8786")

    @classmethod
    def of(cls, config: Mapping[str, Any]) -> "Engine":
        """That of ``compute``, ``scheduler`` and ``workers`` of a configuration.

        Raises
        ------
        ValueError
            If they are unknown, or do not go together.
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
        self, function: Callable[..., Any], tasks: Iterable[tuple], count: int, beside: Callable[[], str] = str
    ) -> Iterator[Any]:
        """What a function gives for every task, in their order, as soon as it is there.

        Parameters
        ----------
        function : callable
        tasks : iterable of tuple
            Its arguments; they are taken as workers get free.
        count : int
            How many there are.
        beside : callable
            Says what results depend on beside this package; a worker where it says something else is refused.

        Raises
        ------
        ValueError
            If the cluster does not answer, is not fit or is lost; it names the address and the remedy.
        """
        if self.scheduler is None:
            # A worker that has grown by 300 MiB is replaced, and says so as if it were an error.
            warnings.filterwarnings("ignore", "A worker stopped while some jobs were given", UserWarning)
            # So does whoever breaks off.
            warnings.filterwarnings("ignore", ".*You could benefit from adjusting the input task iterator", UserWarning)
            pool = joblib.Parallel(min(self.workers or joblib.cpu_count(), max(count, 1)), return_as="generator")
            with ExitStack() as stack:
                with _workers_deaf_to_interrupts():
                    results = pool(joblib.delayed(function)(*task) for task in tasks)
                    stack.callback(results.close)
                yield from results
            return
        yield from cluster.results(self.scheduler, function, tasks, beside)


@contextmanager
def _workers_deaf_to_interrupts() -> Iterator[None]:
    """Workers started meanwhile do not hear Ctrl-C: this process, which does, ends them.

    Heard at any place of theirs, it would be lost in a destructor, or be reported as an error while they start.
    """
    resource_tracker.ensure_running()  # in Python 3.11 its start lets Ctrl-C through again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
