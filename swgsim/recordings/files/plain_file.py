"""Something described by a YAML file from outside."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from swgsim.common.checks import require_known
from swgsim.common.plain_yaml import plain
from swgsim.recordings.files.file_defect import FileDefect, shown
from swgsim.recordings.files.limits import require_readable

LARGEST = 2**20  # bytes

T = TypeVar("T")


def described(path: Path, what: str, example: str, make: Callable[[Any], T]) -> T:
    """What a YAML file describes.

    Parameters
    ----------
    path : Path
    what : str
        Such a file, for messages.
    example : str
        One that a user can look at.
    make : callable
        From the plain data of the file; what it raises is raised with the name of the file.

    Raises
    ------
    FileDefect
        If the file is too large, no YAML, or ``make`` refuses what it says.
    """
    require_readable(path)
    if path.stat().st_size > LARGEST:
        raise FileDefect(str(path), f"{path.stat().st_size} bytes", f"{what} of at most {LARGEST}")
    try:
        return make(plain(path.read_bytes()))
    except (TypeError, ValueError, OverflowError) as error:
        raise FileDefect(str(path), str(error), f"{what} such as {example}") from None


def require_names(owner: str, value: Any, known: Sequence[str] | None = None) -> None:
    """Raise a ValueError unless a value is names with values, and known ones where they are listed."""
    if not isinstance(value, Mapping) or not all(isinstance(key, str) for key in value):
        raise ValueError(f"{owner} is {shown(value)}, must be names with values")
    if known is not None:
        require_known(owner, value, known)
