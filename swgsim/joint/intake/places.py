"""The files of a folder by the patterns of a source; files outside the folder are refused."""

import os
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

from swgsim.joint.intake.source import JointSource
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.limits import inside, require_file_count

ENDINGS = (".csv", ".csv.gz", ".parquet", ".mat")
# Largest number of folders and files in a folder of recordings.
MOST_ENTRIES = 200_000


class Places(NamedTuple):
    """Paths relative to the folder, in order."""

    moving: tuple[str, ...]
    resting: tuple[str, ...]
    unmatched: tuple[str, ...]


def places(folder: Path, source: JointSource) -> Places:
    """Sort the files of a folder by the patterns of a source.

    Raises
    ------
    FileDefect
        If no file matches, there are too many, or one of them is a link out of the folder.
    """
    if not folder.is_dir():
        raise FileDefect(str(folder), "no folder", f"the folder with the recordings of {source.robot}")
    kinds: dict[str, list[str]] = {"moving": [], "resting": [], "unmatched": []}
    for name in sorted(_names(folder)):
        kind = _kind(name, source)
        if kind in ("moving", "resting"):
            inside(folder, name, "the source")
        if kind:
            kinds[kind].append(name)
    if not kinds["moving"]:
        found = f"no file that matches {', '.join(source.files)}"
        raise FileDefect(str(folder), found, f"recordings of {source.robot} that end in {', '.join(ENDINGS)}")
    require_file_count(folder, len(kinds["moving"]) + len(kinds["resting"]))
    return Places(**{kind: tuple(names) for kind, names in kinds.items()})


def _names(folder: Path) -> Iterator[str]:
    """Files with a known ending; links to folders are not followed."""
    entries = 0
    for place, folders, files in os.walk(folder):
        entries += len(folders) + len(files)
        if entries > MOST_ENTRIES:
            raise FileDefect(str(folder), f"more than {MOST_ENTRIES} files and folders", "a folder of recordings")
        for file in files:
            if file.lower().endswith(ENDINGS):
                yield (Path(place) / file).relative_to(folder).as_posix()


def _kind(name: str, source: JointSource) -> str:
    """Field of :class:`Places` for a file; empty if it is left out."""
    for kind, patterns in (("", source.leave_out), ("resting", source.rest), ("moving", source.files)):
        if any(fnmatchcase(name if "/" in pattern else name.rsplit("/", 1)[-1], pattern) for pattern in patterns):
            return kind
    return "unmatched"
