"""Writing of HDF5 files that survives a full disk; HDF5 itself ends the process after a failed write."""

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py


class Raw(io.FileIO):
    """A file that stores its first failure and then ignores all writes."""

    failure: OSError | None = None

    def write(self, content: Any) -> int:
        """Write bytes; HDF5 gets their number even after a failure."""
        rest = memoryview(content)
        while len(rest) and not self.failure:
            try:
                rest = rest[super().write(rest) :]
            except OSError as failure:
                self.failure = failure
        return len(content)

    def require_written(self) -> None:
        """Raise the stored failure."""
        if self.failure:
            raise self.failure


@contextmanager
def created(path: Path, free: int) -> Iterator[tuple[h5py.File, Raw]]:
    """A new HDF5 file with ``free`` bytes before it, and the raw file.

    Raises
    ------
    OSError
        If a write failed: at the end, or earlier by :meth:`Raw.require_written`.
    """
    with Raw(path, "w+") as raw:
        try:
            with h5py.File(raw, "w", userblock_size=free) as file:
                yield file, raw
        finally:
            raw.require_written()  # before errors that follow from it
