"""Recordings from files of other formats, through a column map."""

from pathlib import Path

import numpy as np

from swgsim.recordings.files import facts
from swgsim.recordings.files.assembly import assemble, require_alike
from swgsim.recordings.files.foreign import READERS, read_columns
from swgsim.recordings.files.source_map import SourceMap
from swgsim.recordings.recording import Recording
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.matlab import MatlabReader
from swgsim.tables.limits import inside, require_file_count, require_rows


def read_mapped(path: Path, mapping: SourceMap) -> tuple[Recording, ...]:
    """Recordings of one MATLAB, Parquet or CSV file, or of all in a folder.

    Parameters
    ----------
    path : Path
    mapping : SourceMap
        Result of :func:`swgsim.recordings.files.source_map.read_map`.

    Raises
    ------
    FileDefect
        If files and map disagree, or a file cannot be read.
    """
    folder, files = _files(path, mapping)
    require_file_count(path, len(files))
    with MatlabReader() as matlab:
        recordings = tuple(_read_one(folder, name, mapping, matlab) for name in files)
    require_alike(recordings)
    return recordings


def _files(path: Path, mapping: SourceMap) -> tuple[Path, list[str]]:
    """Folder and names of the files; files that the map lists must be those of the folder."""
    if path.is_file():
        return path.parent, [path.name]
    if not path.is_dir():
        raise FileDefect(str(path), "nothing", "a file or a folder")
    present = sorted(each.name for each in path.iterdir() if each.suffix.lower() in READERS)
    if not mapping.files:
        return path, present
    for name in present:
        if name not in mapping.files:
            raise FileDefect(name, "no entry for this file under 'files' of the map", "one entry per file")
    return path, list(mapping.files)


def _read_one(folder: Path, name: str, mapping: SourceMap, matlab: MatlabReader) -> Recording:
    """The recording of one file; its name is that of the file unless the map gives one."""
    path = inside(folder, name, "the column map")
    own = mapping.files.get(name, {})
    known = facts.parse({"recording": path.stem, **mapping.facts, **own}, name)
    columns = read_columns(path, name, [source.column for source in mapping.channels], matlab)
    lengths = {column: len(values) for column, values in columns.items()}
    if len(set(lengths.values())) > 1:
        raise FileDefect(name, f"columns of different lengths {lengths}", "as many values of every channel")
    with np.errstate(over="ignore"):  # Infinite numbers are refused below.
        channels = {source.channel: source.values(columns[source.column]) for source in mapping.channels}
    if mapping.sampling_rate_hz:
        length = next(iter(lengths.values()), 0)
        require_rows(name, length)
        channels["t"] = np.arange(length) / mapping.sampling_rate_hz
    return assemble(name, known, channels)
