"""Ctrl-C: it is not lost in a destructor, and workers leave it to the process that distributes tasks."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LOST_IN_A_DESTRUCTOR = """
import signal, sys, time
from swgsim.commands import interrupts
if sys.argv[1] == "kept":
    interrupts.kept()
class Removed:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)
try:
    Removed()
    time.sleep(1)
    print("lost")
except KeyboardInterrupt:
    print("heard")
"""
BLOCKED = """
import signal
from swgsim.common.compute import Engine
def blocked():
    return signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, [])
if __name__ == "__main__":
    print(*Engine(2).results(blocked, [()] * 4, 4), blocked())
"""


def run(program: str, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """A program in a process of its own, which handles Ctrl-C."""
    file = folder / "program.py"
    file.write_text(program)
    # A shell ignores Ctrl-C in its background processes, such as these tests, and so would the program.
    return subprocess.run(
        [sys.executable, file, *words], cwd=ROOT, capture_output=True, text=True, check=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip


@pytest.mark.parametrize(("how", "said"), [("as Python does", "lost"), ("kept", "heard")])
def test_ctrl_c_in_a_destructor_is_not_lost(how: str, said: str, tmp_path: Path) -> None:
    done = run(LOST_IN_A_DESTRUCTOR, tmp_path, how)
    assert done.stdout.strip() == said
    assert ("Traceback" in done.stderr) == (said == "lost")


@pytest.mark.end_to_end
def test_workers_ignore_ctrl_c_and_their_owner_does_not(tmp_path: Path) -> None:
    assert run(BLOCKED, tmp_path).stdout.split() == ["True"] * 4 + ["False"]
