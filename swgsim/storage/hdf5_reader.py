"""Opening of HDF5 files to read."""

from pathlib import Path

import h5py


def opened(path: Path) -> h5py.File:
    """An HDF5 file to read, without a lock: HDF5 would refuse it on a network disk that has none.

    A file that is written here is complete or absent, and nobody writes to one that is read.
    """
    return h5py.File(path, "r", locking=False)
