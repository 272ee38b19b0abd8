"""The files of a folder that one map reads together, by what they show."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from swgsim.drafting.file_contents import FileContents, contents_of, joined
from swgsim.drafting.file_names import signals_of
from swgsim.drafting.name_patterns import by_pattern
from swgsim.drafting.text_layout import ELSE
from swgsim.recordings.files.manifest import NAME
from swgsim.tables.endings import ENDINGS, files_of, is_data
from swgsim.tables.file_defect import FileDefect

# Files that are looked at; further ones are taken to be like these.
FILES_READ = 50
# Endings of text that may be notes.
NOTES = (".txt", ".log", ".txt.gz", ".log.gz")


@dataclass(frozen=True, eq=False)
class FolderContents:
    """Runs of a folder.

    Attributes
    ----------
    folder : Path
    runs : mapping of str to FileContents
        First file of a run to what it shows; all have the same columns.
    names : tuple of str
        All files that are read, also those that were not looked at.
    named : bool
        Whether the user named the files; else they are all files of the folder.
    by_signal : bool
        Whether each signal has a file of its own.
    others : mapping of str to str
        Files that the map does not read, and why.
    """

    folder: Path
    runs: Mapping[str, FileContents]
    names: tuple[str, ...]
    named: bool
    by_signal: bool
    others: Mapping[str, str]


def folder_contents(paths: Sequence[Path]) -> FolderContents:
    """Look at some files, or at the files of a folder.

    Raises
    ------
    FileDefect
        If there is no table of numbers, or a manifest, which needs no map.
    """
    path, named = paths[0], len(paths) > 1 or not paths[0].is_dir()
    folder, names = _named(paths) if named else (path, files_of(path))
    if NAME in names:
        raise FileDefect(str(path), NAME, "files without a manifest: recordings with a manifest need no map")
    chosen = [name for name in names if is_data(name) or named]
    chosen = chosen or [name for name in names if name.lower().endswith(NOTES)]
    if not chosen:
        endings = ", ".join(each for each in ENDINGS if not each.endswith(".gz"))
        found = f"the files {', '.join(names[:10]) or 'none'}"
        raise FileDefect(str(path), found, f"files that end in {endings}, .txt or .log; {ELSE}")
    by_signal = signals_of(chosen)
    contents: dict[str, FileContents] = {}
    others: dict[str, str] = {}
    runs = [list(files.items()) for files in by_signal.values()] or [[("", name)] for name in chosen]
    for files in runs[:FILES_READ]:
        try:
            tables = {signal: contents_of(folder / name, name) for signal, name in files}
            contents[files[0][1]] = joined(tables, files[0][1]) if by_signal else tables[""]
        except FileDefect as defect:
            others[files[0][1]] = str(defect)
    if not contents:
        raise FileDefect(str(path), f"no table of numbers ({next(iter(others.values()))})", "recordings")
    contents = by_pattern(contents)
    alike = _alike(contents)
    others |= {name: "other columns" for name in contents if name not in alike}
    kept = tuple(name for files in runs for _, name in files if files[0][1] not in others)
    return FolderContents(folder, {name: contents[name] for name in alike}, kept, named, bool(by_signal), others)


def _named(paths: Sequence[Path]) -> tuple[Path, list[str]]:
    """The folder that some files have in common, and their paths in it."""
    for each in paths:
        if not each.is_file():
            found = "a folder among several names" if each.is_dir() else "nothing"
            raise FileDefect(str(each), found, "files, or one folder with recordings")
    folder = Path(os.path.commonpath([each.parent for each in paths]))
    return folder, [each.relative_to(folder).as_posix() for each in paths]


def _alike(contents: Mapping[str, FileContents]) -> Sequence[str]:
    """The largest group of files with the same columns and the same layout."""
    groups: dict[tuple, list[str]] = {}
    for name, each in contents.items():
        groups.setdefault((each.layout, each.interleaved, each.names), []).append(name)
    return max(groups.values(), key=len)
