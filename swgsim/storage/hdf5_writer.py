"""HDF5 files to write, also on a disk that becomes full: HDF5 itself ends the process after a write that failed."""

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py


class Raw(io.FileIO):
    """A file that keeps its first failure to itself, and from then on takes nothing more."""

    failure: OSError | None = None

    def write(self, content: Any) -> int:
        """Bytes of which HDF5 is to believe that they are written."""
        rest = memoryview(content)
        while len(rest) and not self.failure:
            try:
                rest = rest[super().write(rest) :]
            except OSError as failure:
                self.failure = failure
        return len(content)

    def require_written(self) -> None:
        """Raise what HDF5 was not told."""
        if self.failure:
            raise self.failure


@contextmanager
def created(path: Path, free: int) -> Iterator[tuple[h5py.File, Raw]]:
    """A new HDF5 file whose first ``free`` bytes are left alone, and the file below it.

    Raises
    ------
    OSError
        If something could not be written; at the end, or earlier with :meth:`Raw.require_written`.
    """
    with Raw(path, "w+") as raw:
        try:
            with h5py.File(raw, "w", userblock_size=free) as file:
                yield file, raw
        finally:
            raw.require_written()  # before all that followed from it
