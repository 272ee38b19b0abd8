"""Files that a library reads which trusts them: in a child process with limits of memory and time.

SciPy and others trust sizes and types in a file: a damaged or hostile one can end the process or fill the memory. In
the child it harms nobody. Only names, shapes, plain numbers and the cells of spreadsheets come back. The limits need
Linux; elsewhere a hostile file can still only end the child, but may fill the memory first.
"""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from math import prod
from pathlib import Path
from typing import IO

import numpy as np

from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats import child
from swgsim.tables.formats.contents import Contents, Listed
from swgsim.tables.limits import most_expanded

# SciPy holds a variable up to three times: as bytes, as they are stored, and as the numbers that it returns.
COPIES = 3
# Memory for a library itself, and bytes of numbers that even a slow machine reads in a second.
OWN_MEMORY = 256 * 2**20
BYTES_PER_SECOND = 20_000_000
OWN_SECONDS = 10
INSTALL = "pip install 'swg-workbench[formats]'"


class LimitedReader:
    """A child process that reads any number of files, one after the other; it starts with the first one.

    Use it in a ``with`` block, which ends the process.
    """

    def __init__(self) -> None:
        self._child: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> "LimitedReader":
        return self

    def __exit__(self, *error: object) -> None:
        self._end()

    def contents(self, path: Path, file: str, reader: str, wanted: Sequence[str | int] | None) -> Contents:
        """What a file holds; it stays open until the next one.

        Parameters
        ----------
        path : Path
        file : str
            Its name in messages.
        reader : str
            Module of this package with a function ``opened``.
        wanted : sequence of str or int, optional
            What is looked for; None lists everything.

        Raises
        ------
        FileDefect
            If the file is damaged, its library is not installed, or listing it exceeds the limits. So do the functions
            that read its entries.
        """

        def array(what: str, place: int) -> np.ndarray:
            return self._array(self._answer({"what": what, "place": place}, path, file), file, listed[place].name)

        found = self._answer({**_request(path, file, reader), "wanted": wanted}, path, file)
        listed = [Listed(name, tuple(shape), *rest) for name, shape, *rest in found["listed"]]
        time = (lambda place: array("time", place)) if found["timed"] else None
        return Contents(listed, lambda place: array("read", place), time, found["others"], found["ordered"])

    def cells(self, path: Path, file: str, reader: str, sheet: str | int | None) -> list[list]:
        """Rows of a sheet of a spreadsheet, as numbers, texts, truth values and None.

        Raises
        ------
        FileDefect
            As :meth:`contents`.
        """
        return self._answer({**_request(path, file, reader), "sheet": sheet}, path, file)["cells"]

    def sheets(self, path: Path, file: str, reader: str) -> list[str]:
        """Names of the sheets of a spreadsheet; errors as for :meth:`cells`."""
        return self._answer({**_request(path, file, reader), "sheets": True}, path, file)["sheets"]

    def _answer(self, request: dict, path: Path, file: str) -> dict:
        """The header of the child's answer to one request."""
        stdin, stdout = self._streams()
        with suppress(BrokenPipeError):  # where the child could not start
            stdin.write(json.dumps(request).encode() + b"\n")
            stdin.flush()
        line = stdout.readline()
        sound = f"a sound {path.suffix.lower()}"
        remedy = f"{sound}: save the numbers again, or split the recording"
        memory, seconds = _limits(path)
        limits = f"{memory / 2**20:.0f} MiB of memory or {seconds:.0f} s"
        if not line:
            status = self._end()
            raise FileDefect(
                file, f"a damaged file, or more than {limits}: its reader ended with status {status}", remedy
            )
        answer = json.loads(line)
        if "absent" in answer:
            found = f"{path.suffix.lower()}, which needs the library {answer['absent']}"
            raise FileDefect(file, found, f"that library: {INSTALL}")
        if "defect" in answer:
            raise FileDefect(*answer["defect"])
        if "MemoryError" in answer.get("error", ""):
            raise FileDefect(file, f"a damaged file, or more than {limits}", remedy)
        if "error" in answer:
            raise FileDefect(file, f"a damaged file ({answer['error']})", sound)
        return answer

    def _array(self, answer: dict, file: str, column: str) -> np.ndarray:
        """The array that follows an answer."""
        dtype, shape = np.dtype(answer["kind"]), tuple(answer["shape"])
        if dtype.kind not in "fiu":
            raise FileDefect(file, f"{dtype} of shape {shape}", "real numbers", column=column)
        size = prod(shape) * dtype.itemsize
        raw = self._streams()[1].read(size)
        if len(raw) < size:
            raise FileDefect(file, f"a damaged file: its reader ended with status {self._end()}", "a sound file")
        return np.frombuffer(raw, dtype).reshape(shape).copy()  # which may be changed

    def _streams(self) -> tuple[IO[bytes], IO[bytes]]:
        """Input and output of the child, which is started with one thread: each thread would reserve memory."""
        if self._child is None:
            threads = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
            places = os.pathsep.join(filter(None, sys.path))  # it finds what this process finds
            self._child = subprocess.Popen(
                [sys.executable, "-P", child.__file__],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                env={**os.environ, **threads, "PYTHONPATH": places},
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


def _limits(path: Path) -> tuple[int, float]:
    """Memory [byte] and processor time [s] to read a file."""
    return COPIES * most_expanded(path) + OWN_MEMORY, OWN_SECONDS + most_expanded(path) / BYTES_PER_SECOND


def _request(path: Path, file: str, reader: str) -> dict:
    memory, seconds = _limits(path)
    return {"open": str(path.absolute()), "file": file, "reader": reader, "memory": memory, "seconds": seconds}
