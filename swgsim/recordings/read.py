"""Single entry for recordings of every format, with the checks of their numbers."""

from collections.abc import Iterable
from pathlib import Path

from swgsim.recordings.checks.defect import Defect, accepted, summary, unread_defects, with_columns
from swgsim.recordings.checks.inspection import inspect
from swgsim.recordings.files.folder import read_folder
from swgsim.recordings.files.manifest import NAME
from swgsim.recordings.files.recording_file import read_file
from swgsim.recordings.files.source_map import read_map
from swgsim.recordings.files.sources import read_mapped
from swgsim.recordings.recording import Recording
from swgsim.recordings.recording_set import RecordingSet
from swgsim.tables.file_defect import FileDefect


def read_recordings(path: str | Path, mapping: str | Path | None = None) -> RecordingSet:
    """Usable recordings, with the warnings of the checks.

    Parameters
    ----------
    path : str or Path
        A folder with a manifest, a file of :func:`swgsim.recordings.write_file`, or, with a column map, a file or
        folder of any format (docs/formats.md).
    mapping : str or Path, optional
        A column map (conf/sources/example.yaml).

    Returns
    -------
    RecordingSet
        Its ``defects`` are warnings only.

    Raises
    ------
    ValueError
        If a file cannot be read, or defects forbid the use of the numbers; the message lists all of these.
    """
    found = inspect_recordings(path, mapping)
    require_usable(path, found.defects)
    return found


def require_usable(path: str | Path, defects: Iterable[Defect]) -> None:
    """Raise a ValueError that lists the defects that forbid the use of recordings, if there are any."""
    refused = [defect for defect in defects if defect.severity == "refuse"]
    if refused:
        raise ValueError(f"{path}: these recordings cannot be used\n{summary(refused)}")


def inspect_recordings(path: str | Path, mapping: str | Path | None = None) -> RecordingSet:
    """Recordings with all defects of their numbers, usable or not; parameters as for :func:`read_recordings`.

    Raises
    ------
    ValueError
        If a file cannot be read.
    """
    if mapping is None:
        recordings = _read(Path(path))
        return RecordingSet(recordings, inspect(recordings), str(path))
    column_map = read_map(Path(mapping))
    recordings, unread = read_mapped(Path(path), column_map)
    found = with_columns(inspect(recordings), lambda defect: column_map.columns.get(defect.channel, ""))
    defects = [*unread_defects(unread, "the map"), *accepted(found, column_map.table.accepted)]
    return RecordingSet(recordings, tuple(defects), str(path))


def _read(path: Path) -> tuple[Recording, ...]:
    """Recordings in the formats of this project."""
    if path.is_dir() and (path / NAME).exists():
        return read_folder(path)
    if path.is_file() and path.suffix.lower() in (".h5", ".hdf5", ".nc"):
        return read_file(path)
    expected = f"a folder with {NAME}, an .h5 file of recordings, or mapping= with a column map for other files"
    if not path.exists():
        raise FileDefect(str(path), "nothing", expected)
    tables = sorted(each.name for each in path.glob("*.[cC][sS][vV]"))
    if tables:
        found = f"no {NAME} for {', '.join(tables[:5])}{', …' * (len(tables) > 5)}"
        raise FileDefect(str(path), found, f"{expected} (swg map drafts one)")
    raise FileDefect(str(path), "neither a manifest nor a file of recordings", expected)
