"""Description in a YAML file of a user."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from swgsim.common.checks import require_known
from swgsim.common.plain_yaml import plain
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.limits import require_readable

MOST_BYTES = 2**20  # bytes

T = TypeVar("T")


def described(path: Path, what: str, example: str, make: Callable[[Any], T]) -> T:
    """Object that a YAML file describes.

    Parameters
    ----------
    path : Path
    what : str
        Kind of file, for messages.
    example : str
        Path of an example, for messages.
    make : callable
        Makes the object from the plain data of the file; its errors get the name of the file.

    Raises
    ------
    FileDefect
        If the file is too large, is not YAML, or ``make`` refuses its contents.
    """
    require_readable(path)
    if path.stat().st_size > MOST_BYTES:
        raise FileDefect(str(path), f"{path.stat().st_size} bytes", f"{what} of at most {MOST_BYTES}")
    try:
        return make(plain(path.read_bytes()))
    except (TypeError, ValueError, OverflowError) as error:
        raise FileDefect(str(path), str(error), f"{what} (docs/formats.md; an example is {example})") from None


def require_names(owner: str, value: Any, known: Sequence[str] | None = None) -> None:
    """Raise a ValueError unless a value is a mapping of names, all of them known where they are listed."""
    if not isinstance(value, Mapping) or not all(isinstance(key, str) for key in value):
        raise ValueError(f"{owner} is {shown(value)}, must be names with values")
    if known is not None:
        require_known(owner, value, known)
