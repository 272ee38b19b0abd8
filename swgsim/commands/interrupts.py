"""Repeats a Ctrl-C that arrives in a destructor, where Python only reports it and continues.

This is frequent: a Ctrl-C waits for the end of a long library call, and after the call its objects are removed.
"""

import os
import signal
import sys
import threading
from types import TracebackType
from typing import Any

# Seconds until the repetition.
PAUSE = 0.05


def kept() -> None:
    """Lose no Ctrl-C from now on, and print no report of one."""
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
    """Print errors, but no Ctrl-C, which Cython prints before it reports it."""
    if kind is not KeyboardInterrupt:
        sys.__excepthook__(kind, error, trace)
