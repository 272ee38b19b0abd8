"""The files of a folder that a source means: none outside of it, and none that is left unsaid."""

import os
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

from swgsim.joint.intake.source import JointSource
from swgsim.recordings.files.file_defect import FileDefect
from swgsim.recordings.files.limits import inside, require_file_count

ENDINGS = (".csv", ".csv.gz", ".parquet", ".mat")
# Folders and files that are looked at to find those that are meant.
MOST_ENTRIES = 200_000


class Places(NamedTuple):
    """Paths relative to the folder, in order."""

    moving: tuple[str, ...]
    resting: tuple[str, ...]
    unsaid: tuple[str, ...]


def places(folder: Path, source: JointSource) -> Places:
    """Where the files are.

    Raises
    ------
    FileDefect
        If there is none, or too many, or one of them leads out of the folder.
    """
    if not folder.is_dir():
        raise FileDefect(str(folder), "no folder", f"the folder with the recordings of {source.robot}")
    kinds: dict[str, list[str]] = {"moving": [], "resting": [], "unsaid": []}
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
    """Every file that has an ending that is read; links to folders are not followed."""
    entries = 0
    for place, folders, files in os.walk(folder):
        entries += len(folders) + len(files)
        if entries > MOST_ENTRIES:
            raise FileDefect(str(folder), f"more than {MOST_ENTRIES} files and folders", "a folder of recordings")
        for file in files:
            if file.lower().endswith(ENDINGS):
                yield (Path(place) / file).relative_to(folder).as_posix()


def _kind(name: str, source: JointSource) -> str:
    """Which of :class:`Places` a file is in; empty if it is left out."""
    for kind, patterns in (("", source.leave_out), ("resting", source.rest), ("moving", source.files)):
        if any(fnmatchcase(name if "/" in pattern else name.rsplit("/", 1)[-1], pattern) for pattern in patterns):
            return kind
    return "unsaid"
