"""Version of the code that made a result."""

import hashlib
from functools import cache
from importlib.metadata import version
from pathlib import Path

from swgsim.common.checks import require_known

# The rooms on which recordings depend.
MAKING = ("bench", "chain", "common", "dataset", "effects", "flexspline", "gear", "storage")


PACKAGE = Path(__file__).parents[1]


def rooms() -> list[str]:
    """The names of the rooms, the subpackages of swgsim."""
    return sorted(path.parent.name for path in PACKAGE.glob("*/__init__.py"))


@cache
def code_version(*also: str) -> str:
    """Version of the package, with a digest of the sources that recordings depend on, and of other rooms.

    Parameters
    ----------
    also : str
        Further rooms of swgsim, such as "identification".

    Raises
    ------
    ValueError
        If a room is unknown; the message lists the choices.
    """
    require_known("code_version", also, rooms())
    digest = hashlib.sha256()
    for room in sorted({*MAKING, *also}):
        for source in sorted((PACKAGE / room).rglob("*.py")):
            digest.update(source.read_bytes())
    return f"{version('swg-workbench')}+{digest.hexdigest()[:12]}"


__version__ = version("swg-workbench")


def version_text() -> str:
    """Name and version of the distribution.

    >>> version_text().split()[0]
    'swg-workbench'
    """
    return f"swg-workbench {__version__}"
