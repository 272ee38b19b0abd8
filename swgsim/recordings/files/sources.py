"""Recordings from files of other formats, through a column map."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from swgsim.recordings.files import facts
from swgsim.recordings.files.assembly import assemble, require_alike
from swgsim.recordings.files.source_map import SIGNAL, SourceMap
from swgsim.recordings.recording import Recording
from swgsim.tables.endings import ENDINGS, files_of, is_data
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.head_facts import head_facts
from swgsim.tables.limits import inside, require_file_count
from swgsim.tables.measured_table import first_lost, read_measured
from swgsim.tables.path_pattern import path_groups
from swgsim.tables.several import recordings_in

# Names that a message lists.
LISTED = 10


class Run(NamedTuple):
    """The files of one recording, by their signal, and the facts that their names or the map give."""

    files: dict[str, str]
    known: dict[str, object]


class Mapped(NamedTuple):
    """Recordings through a column map, and files of the folder that it does not name."""

    recordings: tuple[Recording, ...]
    unread: tuple[str, ...]


def read_mapped(path: Path, mapping: SourceMap) -> Mapped:
    """Recordings of one file, or of all in a folder.

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
    folder = path.parent if path.is_file() else path
    if not folder.is_dir():
        raise FileDefect(str(path), "nothing", "a file or a folder")
    names = [path.name] if path.is_file() else files_of(folder)
    runs = list(_by_path(path, names, mapping) if mapping.table.path else _by_name(path, names, mapping))
    require_file_count(path, len(runs))
    with LimitedReader() as reader:
        recordings = tuple(each for run in runs for each in _read_each(folder, run, mapping, reader))
    require_alike(recordings)
    read = {file for run in runs for file in run.files.values()}
    return Mapped(recordings, tuple(name for name in names if is_data(name) and name not in read))


def _by_name(path: Path, names: list[str], mapping: SourceMap) -> Iterator[Run]:
    """One recording for each file of the folder; files that the map lists must be those of the folder."""
    present = names if path.is_file() else [name for name in names if "/" not in name and is_data(name)]
    if not present and not mapping.files:
        found = f"no file of numbers among {', '.join(names[:LISTED]) or 'none'}"
        raise FileDefect(
            str(path), found, f"files that end in {', '.join(ENDINGS)}, or others under 'files' of the map"
        )
    for name in present:
        if mapping.files and name not in mapping.files:
            raise FileDefect(name, "no entry for this file under 'files' of the map", "one entry per file")
    for name in mapping.files if mapping.files and not path.is_file() else present:
        yield Run({"": name}, dict(mapping.files.get(name, {})))


def _by_path(path: Path, names: list[str], mapping: SourceMap) -> Iterator[Run]:
    """Recordings by the groups of their paths; files whose groups differ by the signal only are one recording."""
    runs: dict[tuple, Run] = {}
    for name in names:
        groups = path_groups(mapping.table.path, name)
        if groups is None:
            continue
        signal = groups.pop(SIGNAL, "")
        run = runs.setdefault(tuple(groups.items()) if signal else (name,), Run({}, dict(groups)))
        if signal in run.files:
            raise FileDefect(name, f"the same facts as of {run.files[signal]}", "other groups of 'path' for each file")
        run.files[signal] = name
    if not runs:
        found = f"no file that matches 'path' of the map among {', '.join(names[:LISTED])}"
        raise FileDefect(str(path), found, f"files that match {mapping.table.path}")
    yield from runs.values()


def _read_each(folder: Path, run: Run, mapping: SourceMap, reader: LimitedReader) -> Iterator[Recording]:
    """The recordings of one file, or the one of several."""
    first = next(iter(run.files.values()))
    # What the map says of a file counts more than what the file says.
    run = run._replace(known=head_facts(inside(folder, first, "the column map"), first, mapping.table) | run.known)
    if not mapping.table.each:
        yield from _read_one(folder, run, mapping, reader)
        return
    stem = run.known.get("recording", first.partition(".")[0])
    for each, groups in recordings_in(folder / first, first, mapping.table, reader):
        known = {"recording": f"{stem} {each}", **{k: v for k, v in run.known.items() if k != "recording"}, **groups}
        yield from _read_one(folder, Run(run.files, known), mapping.of(each), reader)


def _read_one(folder: Path, run: Run, mapping: SourceMap, reader: LimitedReader) -> Iterator[Recording]:
    """One recording, or its parts; its name is that of its file unless path or map give one."""
    name = next(iter(run.files.values()))
    for file in run.files.values():
        inside(folder, file, "the column map")
    stem = name.partition(".")[0] if len(run.files) == 1 else " ".join(map(str, run.known.values()))
    known = {"recording": stem, **mapping.facts, **run.known}
    table = read_measured(
        folder, run.files, mapping.channels, mapping.clock, mapping.sampling_rate_hz, mapping.table.layout, reader
    )
    lost = first_lost(folder, run.files, mapping.channels, table, mapping.table.layout)
    if lost:
        raise lost
    pairs = zip(mapping.channels, table.numbers, strict=True)
    assert table.time is not None  # a map has a clock or a rate
    columns = {"t": table.time} | {column.quantity: column.values(numbers) for column, numbers in pairs}
    parts = mapping.table.parts
    if not parts:
        made = assemble(name, facts.parse(known, name), columns, mapping.columns, table.first_row)
        yield replace(made, lost=table.lost)
    for number, part in enumerate(parts, 1):
        rows = part.of(table.time)
        if not len(table.time[rows]):
            length = table.time[-1] - table.time[0]
            expected = f"a length beyond {part.start:g} s, where part {shown(part.name)} begins"
            raise FileDefect(name, f"{length:.4g} s", expected)
        given = facts.parse({"repeat": 1, **known, **part.facts}, name)
        follows = {  # parts of one operating point are repeats that follow one another
            "recording": f"{given['recording']} {part.name}",
            "repeat": given["repeat"] if part.facts else (int(str(given["repeat"])) - 1) * len(parts) + number,
            "elapsed_s": float(str(given["elapsed_s"])) + part.start,
        }
        own = {channel: values[rows] for channel, values in columns.items()}
        made = assemble(name, given | follows, own, mapping.columns, table.first_row + rows.start)
        yield replace(made, lost=table.lost)
