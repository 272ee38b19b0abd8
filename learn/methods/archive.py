"""Check of the ZIP archives that hold models: without compression no content is larger than its file."""

from math import prod
from pathlib import Path
from zipfile import ZIP_STORED, ZipFile, ZipInfo

from numpy.lib import format as npy


def require_plain(path: Path) -> None:
    """Raise unless a file is a ZIP archive with uncompressed, distinct and sound members.

    Raises
    ------
    ValueError
        If a member is compressed, damaged or a duplicate, the members are larger than the file, or an array is larger
        than its member.
    OSError, zipfile.BadZipFile
        If the file is not a ZIP archive.
    """
    with path.open("rb") as raw, ZipFile(raw) as archive:
        members = archive.infolist()
        names = [member.filename for member in members]
        if any(member.compress_type != ZIP_STORED for member in members):
            raise ValueError("a part of it is compressed; models are saved without compression")
        if sum(member.file_size for member in members) > path.stat().st_size or len(set(names)) < len(names):
            raise ValueError("its parts are larger than the file, or one is a duplicate")
        if damaged := archive.testzip():
            raise ValueError(f"{damaged} is damaged")
        for member in members:
            if member.filename.endswith(".npy"):
                _require_room(archive, member)


def _require_room(archive: ZipFile, member: ZipInfo) -> None:
    """Raise a ValueError unless a member is large enough for the array of its header, in NumPy's first format."""
    with archive.open(member) as raw:
        if npy.read_magic(raw) != (1, 0):
            raise ValueError(f"{member.filename} has a format that models are not saved in")
        shape, _, dtype = npy.read_array_header_1_0(raw)
    if prod(shape) * dtype.itemsize > member.file_size:
        raise ValueError(f"{member.filename} is too small for an array of shape {shape}")
