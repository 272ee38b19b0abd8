"""A piece of work in a process group of its own, which is killed after a while."""

import os
import select
import signal
import traceback
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

KILLED = -signal.SIGKILL


def attempt(work: Callable[[], object], seconds: float | None, log: Path) -> int:
    """Do work in a forked process, and kill its whole group if it has not ended by then.

    Parameters
    ----------
    work : callable
        It may replace the process by another program.
    seconds : float or None
        None: it is left alone.
    log : Path
        Takes all that it prints.

    Returns
    -------
    int
        Exit status; the signal, negative, if it ended by one.
    """
    child = os.fork()
    if not child:
        _do(work, log)
    with suppress(PermissionError):  # it has done so itself and is another program by now
        os.setpgid(child, child)
    running = True
    with os.fdopen(os.pidfd_open(child)) as ended:
        try:
            running = not select.select([ended], [], [], seconds)[0]
        finally:
            if running:
                os.killpg(child, signal.SIGKILL)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def _do(work: Callable[[], object], log: Path) -> None:
    """The child: it never returns."""
    status = 1
    try:
        os.setpgid(0, 0)
        said = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(said, 1)
        os.dup2(said, 2)
        work()
        status = 0
    except BaseException:
        traceback.print_exc()
    finally:
        os._exit(status)
