"""Recordings that keep a secret: the truth lies in a file beside their folder, and a seal in the folder vouches for it.

The seal is the SHA-256 of the truth's file, written as ``sha256sum --check`` reads it. The truth holds a salt, so that
nobody finds it by trying effects, and the SHA-256 of every file of the folder. So neither can be changed afterwards
without the other showing it.
"""

import hashlib
import json
import os
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from swgsim.common.files import write_text
from swgsim.recordings.files.folder import write_folder
from swgsim.recordings.recording import Recording

SEAL = "seal.txt"


def truth_of(folder: Path) -> Path:
    """Where the truth of a folder lies."""
    return folder.with_name(f"{folder.name}.truth.json")


def require_new(folder: Path) -> None:
    """Raise a ValueError if the folder or its truth is there already."""
    for path in (folder, truth_of(folder)):
        if path.exists():
            raise ValueError(f"{path} is there already: remove it, or choose another folder with out=...")


def write_sealed(
    folder: Path, recordings: Sequence[Recording], declared: Mapping[str, str], truth: Mapping[str, Any]
) -> None:
    """Write recordings as a folder with a seal, and their truth beside it; the folder is complete or absent.

    Parameters
    ----------
    folder : Path
    recordings : sequence of Recording
    declared : mapping
        Further files of the folder, by name: what may be known.
    truth : mapping
        What may not, with a ``salt``.

    Raises
    ------
    ValueError
        If the folder or its truth is there already.
    """
    require_new(folder)
    aside = folder.with_name(f".{folder.name}.sealing")
    shutil.rmtree(aside, ignore_errors=True)
    try:
        write_folder(aside, recordings)
        for name, text in declared.items():
            write_text(aside / name, text)
        text = json.dumps({**truth, "files": _digests(aside)}, indent=2, allow_nan=False) + "\n"
        write_text(aside / SEAL, f"{_digest(text.encode())}  {truth_of(folder).name}\n")
        write_text(truth_of(folder), text)
        os.replace(aside, folder)
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def vouched(folder: Path, content: bytes) -> bool:
    """Whether the seal of a folder is of the file of a truth that has this content."""
    return (folder / SEAL).read_text(encoding="utf-8", errors="replace").split()[:1] == [_digest(content)]


def open_truth(folder: Path, path: Path | None = None) -> dict[str, Any]:
    """The truth of a folder, once it is certain that neither has been changed.

    Parameters
    ----------
    folder : Path
    path : Path, optional
        Where the truth lies, if not beside the folder.

    Raises
    ------
    ValueError
        If the truth is not the one that was sealed, or a file of the folder is not the one that was recorded.
    """
    path = path or truth_of(folder)
    for needed in (path, folder / SEAL):
        if not needed.is_file():
            raise ValueError(f"no {needed}: {folder} cannot be checked without it")
    content = path.read_bytes()
    if not vouched(folder, content):
        raise ValueError(
            f"{path} is not the truth that was sealed in {folder / SEAL}: one of them was changed afterwards"
        )
    truth = parsed(path, content)
    if not isinstance(truth.get("files"), dict):
        raise ValueError(f"{path} has no digests of the files: it is no truth of scripts/record.py")
    there = _digests(folder)
    changed = sorted(name for name in truth["files"] | there if truth["files"].get(name) != there.get(name))
    if changed:
        raise ValueError(f"{folder} is not as it was recorded: {', '.join(changed)} changed, added or removed")
    return truth


def parsed(path: Path, content: bytes) -> dict[str, Any]:
    """What the file of a truth says.

    Raises
    ------
    ValueError
        If it is no JSON, or no names with values.
    """
    try:
        return dict(json.loads(content))
    except (ValueError, TypeError, RecursionError) as error:  # a ValueError also for an integer of too many digits
        raise ValueError(f"truth={path} is no truth of scripts/record.py ({error})") from error


def _digests(folder: Path) -> dict[str, str]:
    """Those of all files of a folder but the seal."""
    return {path.name: _digest(path.read_bytes()) for path in sorted(folder.iterdir()) if path.name != SEAL}


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
