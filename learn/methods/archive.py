"""The archives in which models are kept: nothing in them is compressed, so that none is larger than its file."""

from math import prod
from pathlib import Path
from zipfile import ZIP_STORED, ZipFile, ZipInfo

from numpy.lib import format as npy


def require_plain(path: Path) -> None:
    """Raise unless a file is a ZIP archive of members that are not compressed, do not overlap and have the right sums.

    Raises
    ------
    ValueError
        If a member is compressed or damaged, or is there twice, or all are more than the file, or an array is more than
        its member.
    OSError, zipfile.BadZipFile
        If it is no such archive.
    """
    with path.open("rb") as raw, ZipFile(raw) as archive:
        members = archive.infolist()
        names = [member.filename for member in members]
        if any(member.compress_type != ZIP_STORED for member in members):
            raise ValueError("a part of it is compressed, which a model that was saved here is not")
        if sum(member.file_size for member in members) > path.stat().st_size or len(set(names)) < len(names):
            raise ValueError("its parts are more than the file, or one is there twice")
        if damaged := archive.testzip():
            raise ValueError(f"{damaged} is damaged")
        for member in members:
            if member.filename.endswith(".npy"):
                _require_room(archive, member)


def _require_room(archive: ZipFile, member: ZipInfo) -> None:
    """Raise a ValueError unless a member has room for the array that it says it holds, in NumPy's first format."""
    with archive.open(member) as raw:
        if npy.read_magic(raw) != (1, 0):
            raise ValueError(f"{member.filename} is of a later format than arrays that are saved here")
        shape, _, dtype = npy.read_array_header_1_0(raw)
    if prod(shape) * dtype.itemsize > member.file_size:
        raise ValueError(f"{member.filename} says it holds {shape} numbers, for which it has no room")
