"""Recordings with hidden effects: a truth file next to their folder, and its seal in the folder.

The seal is the SHA-256 of the truth file, in the format of ``sha256sum --check``. The truth holds a salt, against trial
of effects, and the SHA-256 of every file of the folder. So each reveals later changes of the other.
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
    """Path of the truth of a folder."""
    return folder.with_name(f"{folder.name}.truth.json")


def require_new(folder: Path) -> None:
    """Raise a ValueError if the folder or its truth exists."""
    for path in (folder, truth_of(folder)):
        if path.exists():
            raise ValueError(f"{path} is there already: remove it, or choose another folder with out=...")


def write_sealed(
    folder: Path, recordings: Sequence[Recording], declared: Mapping[str, str], truth: Mapping[str, Any]
) -> None:
    """Write recordings as a folder with a seal, and their truth next to it; the folder is complete or absent.

    Parameters
    ----------
    folder : Path
    recordings : sequence of Recording
    declared : mapping
        Further files of the folder, by name; their contents are public.
    truth : mapping
        Hidden contents, with a ``salt``.

    Raises
    ------
    ValueError
        If the folder or its truth exists.
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
    """Whether the seal of a folder belongs to a truth file with this content."""
    return (folder / SEAL).read_text(encoding="utf-8", errors="replace").split()[:1] == [_digest(content)]


def open_truth(folder: Path, path: Path | None = None) -> dict[str, Any]:
    """The truth of a folder, after a check that neither was changed.

    Parameters
    ----------
    folder : Path
    path : Path, optional
        Path of the truth, by default next to the folder.

    Raises
    ------
    ValueError
        If the truth or a file of the folder is missing or was changed.
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
        raise ValueError(f"{path} has no digests of the files: it is no truth of swg record")
    present = _digests(folder)
    changed = sorted(name for name in truth["files"] | present if truth["files"].get(name) != present.get(name))
    if changed:
        raise ValueError(f"{folder} is not as it was recorded: {', '.join(changed)} changed, added or removed")
    return truth


def parsed(path: Path, content: bytes) -> dict[str, Any]:
    """The contents of a truth file.

    Raises
    ------
    ValueError
        If it is not a JSON object.
    """
    try:
        return dict(json.loads(content))
    except (ValueError, TypeError, RecursionError) as error:  # a ValueError also for an integer of too many digits
        raise ValueError(f"truth={path} is no truth of swg record ({error})") from error


def _digests(folder: Path) -> dict[str, str]:
    """SHA-256 of all files of a folder but the seal."""
    return {path.name: _digest(path.read_bytes()) for path in sorted(folder.iterdir()) if path.name != SEAL}


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
