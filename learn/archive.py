"""The archives in which models are kept: nothing in them is compressed, so that none is larger than its file."""

from pathlib import Path
from zipfile import ZIP_STORED, ZipFile


def require_plain(path: Path) -> None:
    """Raise unless a file is a ZIP archive of members that are not compressed, do not overlap and have the right sums.

    Raises
    ------
    ValueError
        If a member is compressed or damaged, or is there twice, or all are more than the file.
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
