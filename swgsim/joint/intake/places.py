"""The runs of a folder by the patterns of a source; files outside the folder are refused."""

from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

from swgsim.joint.intake.source import JointSource
from swgsim.tables.endings import files_of, is_data
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.limits import inside, require_file_count
from swgsim.tables.path_pattern import path_groups

# Names that a message lists.
LISTED_NAMES = 10


class RunFiles(NamedTuple):
    """The files of one run.

    Attributes
    ----------
    files : dict
        Value of the group ``signal`` to path in the folder; one file has the key ``""``.
    session, run : str
    joint : str
        Joint that moved, by the path; empty for all.
    """

    files: dict[str, str]
    session: str
    run: str
    joint: str

    @property
    def name(self) -> str:
        """Path of its first file."""
        return next(iter(self.files.values()))


class Places(NamedTuple):
    """Runs in motion and at standstill, and paths that no pattern matches, in order."""

    moving: tuple[RunFiles, ...]
    resting: tuple[RunFiles, ...]
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
    names = files_of(folder)
    kinds: dict[str, list[str]] = {"": [], "moving": [], "resting": [], "unmatched": []}
    for name in names:
        kinds[_kind(name, source)].append(name)
    for name in (*kinds["moving"], *kinds["resting"]):
        inside(folder, name, "the source")
    if not kinds["moving"]:
        found = f"no file that matches {', '.join(source.files)} among {', '.join(names[:LISTED_NAMES]) or 'none'}"
        raise FileDefect(str(folder), found, f"recordings of {source.robot}, by 'files' of the source")
    moving, resting = (_runs(kinds[kind], source) for kind in ("moving", "resting"))
    require_file_count(folder, len(moving) + len(resting))
    return Places(moving, resting, tuple(filter(is_data, kinds["unmatched"])))


def _runs(names: Sequence[str], source: JointSource) -> tuple[RunFiles, ...]:
    """Runs by the groups of their paths; files whose groups differ by the signal only are one run."""
    runs: dict[tuple[str, ...], RunFiles] = {}
    for name in names:
        groups = path_groups(source.table.path, name) if source.table.path else {}
        if groups is None:
            expected = f"one that matches {source.table.path}"
            raise FileDefect(name, "a path that does not match 'path' of the source", expected)
        signal = groups.get("signal", "")
        place = name.rpartition("/")[0]
        run = groups.get("run") or groups.get("session") or (place or "run" if signal else name.partition(".")[0])
        found = RunFiles({}, groups.get("session", run), run, groups.get("joint", ""))
        own = runs.setdefault(found[1:] if signal else (name,), found)
        if signal in own.files:
            raise FileDefect(name, f"the same run as {own.files[signal]}", "other groups of 'path' for each file")
        own.files[signal] = name
    return tuple(runs.values())


def _kind(name: str, source: JointSource) -> str:
    """Field of :class:`Places` for a file; empty if it is left out."""
    for kind, patterns in (("", source.leave_out), ("resting", source.rest), ("moving", source.files)):
        if any(fnmatchcase(name if "/" in pattern else name.rsplit("/", 1)[-1], pattern) for pattern in patterns):
            return kind
    return "unmatched"
