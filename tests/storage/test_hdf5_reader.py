"""HDF5 files are read on disks without locks."""

import fcntl
from pathlib import Path

import h5py
import pytest

from swgsim.storage.hdf5_reader import opened


def test_a_file_is_read_without_a_lock(tmp_path: Path) -> None:
    """Another process's lock stands for a disk that has none: whoever asks for a lock is refused."""
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file["x"] = 1.0
    with path.open("rb") as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        with pytest.raises(OSError, match="lock"):
            h5py.File(path, "r", locking=True)
        with opened(path) as file:
            assert file["x"][()] == 1.0
