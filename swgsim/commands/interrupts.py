"""Ctrl-C that comes while an object is removed, where Python only reports it and goes on, as if it were pressed again.

Much of it comes there: it waits for the end of a long call of a library, and what that leaves is removed next.
"""

import os
import signal
import sys
import threading
from types import TracebackType
from typing import Any

# Seconds until it is pressed again.
PAUSE = 0.05


def kept() -> None:
    """Lose no Ctrl-C from now on, and let no library report one."""
    sys.unraisablehook = _unraisable
    sys.excepthook = _printed


def _unraisable(report: Any) -> None:
    if report.exc_type is KeyboardInterrupt:
        again = threading.Timer(PAUSE, os.kill, [os.getpid(), signal.SIGINT])
        again.daemon = True
        again.start()
    else:
        sys.__unraisablehook__(report)


def _printed(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Cython prints what it cannot raise before it reports it."""
    if kind is not KeyboardInterrupt:
        sys.__excepthook__(kind, error, trace)
