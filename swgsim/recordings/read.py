"""The one way in for recordings: whatever form they have, with what their numbers say of the test bench."""

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from swgsim.recordings.checks.defect import Defect, summary
from swgsim.recordings.checks.inspection import inspect
from swgsim.recordings.files.file_defect import FileDefect
from swgsim.recordings.files.folder import read_folder
from swgsim.recordings.files.manifest import NAME
from swgsim.recordings.files.recording_file import read_file
from swgsim.recordings.files.source_map import read_map
from swgsim.recordings.files.sources import read_mapped
from swgsim.recordings.recording import Recording


class Intake(NamedTuple):
    """Recordings, and what was detected in their numbers."""

    recordings: tuple[Recording, ...]
    defects: tuple[Defect, ...]


def read_recordings(path: Path, mapping: Path | None = None) -> Intake:
    """Recordings that may be used; what is left to tell of them are warnings.

    Parameters
    ----------
    path : Path
        A folder with a manifest, a file of :func:`recording_file.write_file`, or, with a map, files of
        others.
    mapping : Path, optional
        A column map (conf/sources/example.yaml).

    Raises
    ------
    ValueError
        If a file cannot be read, or the numbers have a defect that forbids their use; all of those are listed.
    """
    intake = inspect_recordings(path, mapping)
    require_usable(path, intake.defects)
    return intake


def require_usable(path: Path, defects: Iterable[Defect]) -> None:
    """Raise a ValueError that lists the defects that forbid the use of recordings, if there are any."""
    refused = [defect for defect in defects if defect.severity == "refuse"]
    if refused:
        raise ValueError(f"{path}: these recordings cannot be used\n{summary(refused)}")


def inspect_recordings(path: Path, mapping: Path | None = None) -> Intake:
    """Recordings with all that was detected in them, whether they may be used or not.

    Raises
    ------
    ValueError
        If a file cannot be read.
    """
    recordings = _read(path, mapping)
    return Intake(recordings, inspect(recordings))


def _read(path: Path, mapping: Path | None) -> tuple[Recording, ...]:
    if mapping is not None:
        return read_mapped(path, read_map(mapping))
    if path.is_dir() and (path / NAME).exists():
        return read_folder(path)
    if path.is_file() and path.suffix.lower() in (".h5", ".hdf5", ".nc"):
        return read_file(path)
    found = "nothing" if not path.exists() else "neither a manifest nor a file of recordings"
    expected = f"a folder with {NAME}, an .h5 file of recordings, or a column map beside files of others"
    raise FileDefect(str(path), found, expected)
