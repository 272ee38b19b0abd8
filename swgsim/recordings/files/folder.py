"""Recordings as a folder: one CSV file each, and a manifest. It is the format for people with a test bench."""

import os
import shutil
from collections.abc import Sequence
from pathlib import Path

from swgsim.recordings.files import facts, manifest
from swgsim.recordings.files.assembly import assemble, column_of, require_alike, require_sound
from swgsim.recordings.recording import CHANNELS, Recording
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.layout import Layout
from swgsim.tables.limits import require_file_count, require_readable
from swgsim.tables.text import read_text, start_of

OR_MAPPING = "or give other names and units in a column map, with mapping="
CHANNEL_OF = {"t_s": "t", **{channel.column: name for name, channel in CHANNELS.items()}}


def read_folder(folder: Path) -> tuple[Recording, ...]:
    """The recordings of a folder, in the order of its manifest.

    A wrapped angle is unwrapped; all other numbers are those of the files. The checks of the numbers are in
    :func:`swgsim.recordings.checks.inspection.inspect`.

    Raises
    ------
    FileDefect
        If anything is missing, unknown or not a number.
    """
    recordings = []
    for path, known in manifest.read(folder):
        name = str(path.relative_to(folder))
        require_readable(path)
        columns = start_of(path, name, Layout()).names
        for column in columns:
            if column not in CHANNEL_OF:
                raise FileDefect(name, f"unknown column {shown(column)}", _choices(column), 1)
        if "t_s" not in columns:
            raise FileDefect(name, "no column t_s", f"the time of each sample in seconds, {OR_MAPPING}", 1)
        table = read_text(path, name, columns, Layout())
        channels = {CHANNEL_OF[str(column)]: values.astype(float) for column, values in table.items()}
        recordings.append(assemble(name, known, channels))
    require_alike(recordings)
    return tuple(recordings)


def write_folder(folder: Path, recordings: Sequence[Recording]) -> None:
    """Write recordings as a folder, which is complete or absent; reading returns every number exactly.

    Raises
    ------
    ValueError
        If the folder exists, or a recording could not be read back.
    """
    if folder.exists():
        raise ValueError(f"{folder} exists: remove it or choose another folder")
    require_file_count(folder, len(recordings))
    require_alike(recordings)
    aside = folder.with_name(f".{folder.name}.tmp")
    shutil.rmtree(aside, ignore_errors=True)
    aside.mkdir(parents=True)
    try:
        rows = []
        for number, recording in enumerate(recordings, 1):
            known = facts.of(recording)
            facts.parse(known, f"recording {recording.name}")
            file = f"recording_{number:04d}.csv"
            _write_table(aside / file, recording)
            rows.append((file, known))
        (aside / manifest.NAME).write_text(manifest.text(rows), encoding="utf-8", newline="")
        os.replace(aside, folder)
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def _write_table(path: Path, recording: Recording) -> None:
    """One file; repr writes the shortest text of a number that is read back exactly."""
    columns = {
        "t": recording.time,
        **{name: recording.channels[name] for name in CHANNELS if name in recording.channels},
    }
    require_sound(f"recording {recording.name}", columns)
    cells = [map(repr, values.tolist()) for values in columns.values()]
    with path.open("w", encoding="utf-8", newline="") as stream:
        stream.write(",".join(map(column_of, columns)) + "\n")
        stream.writelines(",".join(row) + "\n" for row in zip(*cells, strict=True))


def _choices(column: str) -> str:
    """The expected columns; for a quantity in another unit, its unit."""
    for name, channel in CHANNELS.items():
        if column.lower().startswith(name.lower()):
            return f"{channel.column} in {channel.unit}: convert it, {OR_MAPPING}"
    return f"some of {','.join(CHANNEL_OF)}; rename it, {OR_MAPPING}"
