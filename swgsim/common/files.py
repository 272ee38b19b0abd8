"""Files that are complete or absent, and that only one process at a time makes.

Locks are those of Linux and macOS (flock). The kernel releases them when a process dies.
"""

import errno
import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO, Any

try:
    import fcntl
except ModuleNotFoundError:
    raise ImportError("swgsim needs Linux or macOS: on Windows run it in WSL") from None

# Remedies where a file cannot be written.
ROOM = "make room and start again, what is finished is kept"
OTHER_FOLDER = "choose a folder that can be written"
OTHER_FOLDER_WITH_LOCKS = "choose a folder on a disk that has locks (flock)"
REMEDIES = {
    errno.ENOSPC: ROOM,
    errno.EDQUOT: ROOM,
    errno.EFBIG: "raise the limit of file sizes (ulimit -f) and start again, what is finished is kept",
    errno.EROFS: OTHER_FOLDER,
    errno.EACCES: OTHER_FOLDER,
    errno.EPERM: OTHER_FOLDER,
    errno.ENOLCK: OTHER_FOLDER_WITH_LOCKS,
    errno.EOPNOTSUPP: OTHER_FOLDER_WITH_LOCKS,
}
# Remedies where a folder cannot be made; for a file these errors may mean that another file is missing.
NO_FOLDER = dict.fromkeys((errno.ENOENT, errno.EEXIST, errno.ENOTDIR, errno.ENAMETOOLONG), "choose another folder")


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A temporary file to write, which replaces ``path`` on success.

    Its name is always the same, so the next process overwrites the remains of a killed one.

    Raises
    ------
    OSError
        If the disk is full or the folder cannot be written; the message names file and remedy.
    """
    aside = path.with_name(f".{path.name}.tmp")
    with remedied(path):
        make_folder(path.parent)
        try:
            yield aside
            with aside.open("r+b") as raw:
                os.fsync(raw.fileno())
            os.replace(aside, path)
        finally:
            aside.unlink(missing_ok=True)


@contextmanager
def sole_maker(path: Path, *, wait: bool = False) -> Iterator[None]:
    """Be the only process that makes ``path``; the lock of a killed process is released.

    Parameters
    ----------
    path : Path
    wait : bool
        Wait for another process that is making it; then the file may be complete already.

    Raises
    ------
    RuntimeError
        If another process is making it and ``wait`` is false.
    OSError
        If the folder cannot be written; the message names file and remedy.
    """
    lock = path.with_name(f".{path.name}.lock")
    with remedied(path):
        make_folder(path.parent)
        owned = _locked(lock, path, wait)
    with owned:
        try:
            yield
        finally:
            lock.unlink(missing_ok=True)


@contextmanager
def remedied(path: Path, remedies: Mapping[int, str] = REMEDIES) -> Iterator[None]:
    """Add the file or folder and a remedy to the message of an OSError."""
    try:
        yield
    except OSError as error:
        number = error.errno or 0
        if number not in remedies:
            raise
        raise OSError(number, f"{os.strerror(number)}: {path} was not written; {remedies[number]}") from error


def make_folder(folder: Path) -> None:
    """Make a folder unless it exists.

    Raises
    ------
    OSError
        If it cannot be made; the message names folder and remedy.
    """
    with remedied(folder, {**REMEDIES, **NO_FOLDER}):
        folder.mkdir(parents=True, exist_ok=True)


def require_writable(folder: Path) -> None:
    """Make a folder and test that it can be written, before a long computation.

    Raises
    ------
    OSError
        If the folder cannot be written; the message names folder and remedy.
    """
    make_folder(folder)
    with remedied(folder), TemporaryFile(dir=folder):
        pass


def _locked(lock: Path, path: Path, wait: bool) -> IO[bytes]:
    """The lock file, open and locked until it is closed."""
    while True:
        raw = lock.open("wb")
        try:
            fcntl.flock(raw, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raw.close()
            if not isinstance(error, BlockingIOError):
                raise
            raise RuntimeError(f"another process is making {path}: wait for it, or choose another folder") from None
        if _is_at(raw, lock):
            return raw
        # Its last owner removed the file after it was opened here, so this lock would not exclude anybody.
        raw.close()


def _is_at(raw: IO[bytes], path: Path) -> bool:
    """Whether an open file is still the one at a path."""
    try:
        return os.path.samestat(os.fstat(raw.fileno()), path.stat())
    except FileNotFoundError:
        return False


def write_text(path: Path, text: str) -> None:
    """Write a text; the file is complete or absent."""
    with replacing(path) as aside:
        aside.write_text(text, encoding="utf-8")


def write_json(path: Path, value: Any) -> None:
    """Write indented JSON; NaN is an error."""
    write_text(path, json.dumps(value, indent=2, allow_nan=False) + "\n")
