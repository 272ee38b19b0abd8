"""MATLAB files of versions 4 and 5, read by SciPy in a child process with limits of memory and time.

SciPy trusts sizes and types in a file: a damaged or hostile one can end the process or fill the memory. In the child it
harms nobody. Only names, shapes and plain numbers come back. The limits need Linux; elsewhere a hostile file can still
only end the child, but may fill the memory first.
"""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from math import prod
from pathlib import Path
from typing import IO, NamedTuple

import numpy as np

from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats import matlab_child
from swgsim.tables.limits import most_expanded

# SciPy holds a variable up to three times: as bytes, as they are stored, and as the numbers that it returns.
COPIES = 3
# Memory for SciPy itself, and bytes of numbers that even a slow machine reads in a second.
OWN_MEMORY = 256 * 2**20
BYTES_PER_SECOND = 20_000_000
OWN_SECONDS = 10
REMEDY = "a sound .mat: save the numbers again, or split the recording"


class Variable(NamedTuple):
    """Name, shape and MATLAB class of a variable, such as ``double`` or ``struct``."""

    name: str
    shape: tuple[int, ...]
    kind: str


class MatlabReader:
    """A child process that reads any number of files, one after the other; it starts with the first one.

    Use it in a ``with`` block, which ends the process.
    """

    def __init__(self) -> None:
        self._child: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> "MatlabReader":
        return self

    def __exit__(self, *error: object) -> None:
        self._end()

    def variables(self, path: Path, file: str) -> list[Variable]:
        """All variables of a file, in their order.

        Parameters
        ----------
        path : Path
        file : str
            Its name in messages.

        Raises
        ------
        FileDefect
            If the file is damaged, or listing it exceeds the limits.
        """
        found = self._answer(path, file, None)["variables"]
        return [Variable(name, tuple(shape), kind) for name, shape, kind in found]

    def numbers(self, path: Path, file: str, names: Sequence[str]) -> dict[str, np.ndarray]:
        """Variables by name, in the shape and type of the file.

        Raises
        ------
        FileDefect
            If the file is damaged, a variable holds no real numbers, or reading it exceeds the limits.
        """
        found = self._answer(path, file, list(names))["arrays"]
        for name, (kind, shape) in zip(names, found, strict=True):
            if np.dtype(kind).kind not in "fiu":
                raise FileDefect(file, f"{np.dtype(kind)} of shape {tuple(shape)}", "real numbers", column=name)
        return {name: self._array(np.dtype(kind), shape) for name, (kind, shape) in zip(names, found, strict=True)}

    def _answer(self, path: Path, file: str, names: list[str] | None) -> dict:
        """The header of the child's answer to one request."""
        memory = COPIES * most_expanded(path) + OWN_MEMORY
        seconds = OWN_SECONDS + most_expanded(path) / BYTES_PER_SECOND
        request = {"path": str(path.absolute()), "names": names, "memory": memory, "seconds": seconds}
        stdin, stdout = self._streams()
        with suppress(BrokenPipeError):  # where the child could not start
            stdin.write(json.dumps(request).encode() + b"\n")
            stdin.flush()
        line = stdout.readline()
        limits = f"{memory / 2**20:.0f} MiB of memory or {seconds:.0f} s"
        if not line:
            status = self._end()
            found = f"a damaged file, or more than {limits}: its reader ended with status {status}"
            raise FileDefect(file, found, REMEDY)
        answer = json.loads(line)
        if "MemoryError" in answer.get("error", ""):
            raise FileDefect(file, f"a damaged file, or more than {limits}", REMEDY)
        if "error" in answer:
            raise FileDefect(file, f"a damaged file ({answer['error']})", "a sound .mat")
        return answer

    def _array(self, dtype: np.dtype, shape: Sequence[int]) -> np.ndarray:
        """The next array of the answer."""
        count = prod(shape)
        return np.frombuffer(self._streams()[1].read(count * dtype.itemsize), dtype, count).reshape(shape)

    def _streams(self) -> tuple[IO[bytes], IO[bytes]]:
        """Input and output of the child, which is started with one thread: each thread would reserve memory."""
        if self._child is None:
            self._child = subprocess.Popen(
                [sys.executable, "-P", matlab_child.__file__],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                env={**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"},
            )  # fmt: skip
        assert self._child.stdin
        assert self._child.stdout
        return self._child.stdin, self._child.stdout

    def _end(self) -> int | None:
        """End the child, if there is one, and return its exit status; a negative one is a signal."""
        if self._child is None:
            return None
        child, self._child = self._child, None
        with suppress(subprocess.TimeoutExpired):  # let it report its own status, if it is about to end
            child.wait(0.1 if child.poll() is None else 0)
        child.kill()
        with suppress(BrokenPipeError):
            child.communicate()
        return child.returncode
