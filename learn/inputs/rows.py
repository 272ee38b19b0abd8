"""Rows of numbers that are too many for the memory: in a file, and read when they are asked for."""

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


class Open:
    """An open file without a name, which is closed, and gone, when nobody reads it any more."""

    def __init__(self, descriptor: int):
        self.descriptor = descriptor
        weakref.finalize(self, os.close, descriptor)


class Rows:
    """Rows of a table in a file, all of them or a choice, in their order.

    A slice of them or a choice is again such rows, and reads nothing; ``np.asarray`` reads them all. The file is read
    and not mapped, so that nothing of it counts as memory of the process.

    Parameters
    ----------
    file : Open
        Rows of double precision, one after the other.
    columns : int
    numbers : array (row,)
        Of the rows in the file.
    """

    ndim, dtype = 2, np.dtype(np.float64)

    def __init__(self, file: "Open", columns: int, numbers: Int[np.ndarray, " row"]):
        self._file, self._numbers = file, numbers
        self.shape = (len(numbers), columns)

    def __len__(self) -> int:
        return len(self._numbers)

    def __getitem__(self, chosen: slice | np.ndarray) -> "Rows":
        return Rows(self._file, self.shape[1], self._numbers[chosen])

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        table = np.empty(self.shape)
        size = self.shape[1] * self.dtype.itemsize
        for row, number in zip(table, self._numbers.tolist(), strict=True):
            if os.preadv(self._file.descriptor, [row.data], number * size) < size:
                raise OSError(f"row {number} of a file of inputs could not be read: its disk may have gone away")
        return table if dtype is None else table.astype(dtype, copy=False)


Inputs = Float[np.ndarray, "row feature"] | Rows  # in memory or not


def on_disk(parts: Iterable[Float[np.ndarray, "_ column"]], folder: Path) -> Rows:
    """Rows that come in parts, in a file without a name in a folder."""
    with remedied(folder), tempfile.TemporaryFile(dir=folder) as file:
        rows = columns = 0
        for part in parts:
            file.write(np.ascontiguousarray(part, dtype=Rows.dtype).data)
            rows, columns = rows + len(part), part.shape[1]
        file.flush()
        return Rows(Open(os.dup(file.fileno())), columns, np.arange(rows))


def chunks(X: Inputs) -> Iterator[Float[np.ndarray, "chunk column"]]:
    """Rows in memory, so many at a time; of no rows, none once."""
    for start in range(0, max(len(X), 1), CHUNK):
        yield np.asarray(X[start : start + CHUNK])


def as_tensor(X: Inputs) -> "Tensor":
    """A copy of the rows as networks take them, in single precision, on the processor."""
    import torch

    return torch.from_numpy(np.array(X, dtype=np.float32, order="C"))
