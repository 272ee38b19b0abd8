"""Rows of features that exceed the memory: they stay in a file and are read when needed."""

import os
import tempfile
import weakref
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float, Int

from swgsim.common.files import remedied

if TYPE_CHECKING:
    from torch import Tensor

CHUNK = 1024  # rows in memory at a time


class OpenFile:
    """An open file without a name; it is closed, and its space freed, with the last reference to it."""

    def __init__(self, descriptor: int):
        self.descriptor = descriptor
        weakref.finalize(self, os.close, descriptor)


class Rows:
    """All or selected rows of a table in a file.

    A slice or a selection is again Rows and reads nothing; ``np.asarray`` reads all rows. The file is read and not
    mapped, so it does not count as memory of the process.

    Parameters
    ----------
    file : OpenFile
        Consecutive rows.
    columns : int
        Number of columns.
    numbers : array (row,)
        Numbers of the rows in the file.
    dtype : data type
        Of the numbers in the file.
    """

    ndim = 2

    def __init__(self, file: OpenFile, columns: int, numbers: Int[np.ndarray, " row"], dtype: np.dtype):
        self._file, self._numbers, self.dtype = file, numbers, dtype
        self.shape = (len(numbers), columns)

    def __len__(self) -> int:
        return len(self._numbers)

    def __getitem__(self, chosen: slice | np.ndarray) -> "Rows":
        return Rows(self._file, self.shape[1], self._numbers[chosen], self.dtype)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        table = np.empty(self.shape, self.dtype)
        size = self.shape[1] * self.dtype.itemsize
        for row, number in zip(table, self._numbers.tolist(), strict=True):
            if os.preadv(self._file.descriptor, [row.data], number * size) < size:
                raise OSError(f"row {number} of a file of inputs could not be read: its disk may have gone away")
        return table if dtype is None else table.astype(dtype, copy=False)


Inputs = Float[np.ndarray, "row feature"] | Rows  # in memory, or in a file


def on_disk(parts: Iterable[Float[np.ndarray, "_ column"]], folder: Path) -> Rows:
    """Write consecutive parts of a table, all of the type of the first, to a file without a name in a folder."""
    with remedied(folder), tempfile.TemporaryFile(dir=folder) as file:
        rows, columns, dtype = 0, 0, np.dtype(np.float64)
        for part in parts:
            dtype = part.dtype if not rows else dtype
            file.write(np.ascontiguousarray(part, dtype=dtype).data)
            rows, columns = rows + len(part), part.shape[1]
        file.flush()
        return Rows(OpenFile(os.dup(file.fileno())), columns, np.arange(rows), dtype)


def chunks(X: Inputs) -> Iterator[Float[np.ndarray, "chunk column"]]:
    """Rows in memory, at most CHUNK at a time; an empty table gives one empty chunk."""
    for start in range(0, max(len(X), 1), CHUNK):
        yield np.asarray(X[start : start + CHUNK])


def as_tensor(X: Inputs) -> "Tensor":
    """A copy of the rows in single precision on the processor, for networks."""
    import torch

    return torch.from_numpy(np.array(X, dtype=np.float32, order="C"))
