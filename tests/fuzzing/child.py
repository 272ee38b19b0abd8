"""Readings in a process of their own, within limits of memory and time, watched for what no reader has to do."""

import json
import os
import resource
import select
import signal
import sys
import traceback
import warnings
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

# What reading may take beyond the libraries [byte], one reading [s], and one on a busy machine [s].
MEMORY, SECONDS, WAIT = 2 * 2**30, 10.0, 180.0

# Events of the interpreter that no file may cause; compiling and importing is also done by libraries themselves.
FORBIDDEN = (
    "os.system", "os.exec", "os.posix_spawn", "os.spawn", "os.fork", "subprocess.", "socket.", "webbrowser.",
    "pty.spawn", "ctypes.dlopen", "shutil.", "os.remove", "os.rename", "os.chmod", "os.symlink", "code.",
)  # fmt: skip


class Outcome(NamedTuple):
    """What a reading came to (accepted, refused, crashed, hung, memory, executed), and why."""

    kind: str
    detail: str


class Batch(NamedTuple):
    """Outcomes up to the first that ended the process, and the most memory that it had, libraries included [byte]."""

    outcomes: tuple[Outcome, ...]
    memory: int


def attempt(read: Callable[[Path], Any], folder: Path, file: Path, contents: Sequence[bytes]) -> Batch:
    """Read a folder once for each content of a file in it, in a child process.

    Parameters
    ----------
    read : callable
    folder, file : Path
    contents : sequence of bytes
    """
    ours, theirs = os.pipe()
    child = os.fork()
    if not child:
        os.close(ours)
        _read(read, folder, file, contents, theirs)
    os.close(theirs)
    outcomes, ended = tuple(_said(ours)), ""
    if len(outcomes) < len(contents):
        os.kill(child, signal.SIGKILL)
    os.close(ours)
    _, status, used = os.wait4(child, 0)
    code = os.waitstatus_to_exitcode(status)
    if len(outcomes) < len(contents):
        hung = code in (-signal.SIGPROF, -signal.SIGKILL)
        ended = f"more than {SECONDS:g} s" if hung else f"exit status {code}, a signal if below 0"
        outcomes += (Outcome("hung" if hung else "crashed", ended),)
    return Batch(outcomes, 1024 * used.ru_maxrss)


def _said(pipe: int) -> Iterator[Outcome]:
    """Outcomes as they come, until the child has ended or says nothing any more."""
    with os.fdopen(os.dup(pipe), "rb", buffering=0) as lines:
        rest = b""
        while select.select([lines], [], [], WAIT)[0] and (more := lines.read(65536)):
            *whole, rest = (rest + more).split(b"\n")
            yield from (Outcome(*json.loads(line)) for line in whole)


def _read(read: Callable[[Path], Any], folder: Path, file: Path, contents: Sequence[bytes], pipe: int) -> None:
    """The child: it never returns."""
    happened: list[str] = []
    quiet = os.open(os.devnull, os.O_WRONLY)
    os.dup2(quiet, 1)
    os.dup2(quiet, 2)
    warnings.simplefilter("ignore")
    resource.setrlimit(resource.RLIMIT_AS, (_address_space() + MEMORY,) * 2)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    sys.addaudithook(lambda event, _: happened.append(event) if event.startswith(FORBIDDEN) else None)
    for content in contents:
        file.write_bytes(content)
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        try:
            read(folder)
            outcome = Outcome("accepted", "")
        except BaseException as error:
            outcome = judged(error, folder)
        if happened:
            outcome = Outcome("executed", happened[0])
            happened.clear()
        os.write(pipe, json.dumps([outcome.kind, outcome.detail[:1000]]).encode() + b"\n")
    os._exit(0)


def judged(error: BaseException, folder: Path) -> Outcome:
    """A refusal is a ValueError that names a file; memory that ran out on the way is none."""
    chain, each = [], error
    while each is not None:
        chain.append(each)
        each = each.__cause__ or each.__context__  # type: ignore[assignment]
    if any(isinstance(each, MemoryError) for each in chain):
        return Outcome("memory", repr(chain[-1]))
    names = {str(folder), *(path.name for path in folder.rglob("*"))}
    if isinstance(error, ValueError) and (hasattr(error, "file") or any(name in str(error) for name in names)):
        return Outcome("refused", str(error))
    place = traceback.extract_tb(error.__traceback__)[-1]
    return Outcome("crashed", f"{type(error).__name__} in {Path(place.filename).name}:{place.lineno}: {error}")


def _address_space() -> int:
    """Of this process [byte]."""
    return int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
