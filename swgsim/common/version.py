"""Version of the code that made a result."""

import hashlib
from functools import cache
from importlib.metadata import version
from pathlib import Path

from swgsim.common.checks import require_known

# The subpackages on which recordings depend.
MAKING = ("bench", "chain", "common", "dataset", "effects", "flexspline", "gear", "storage")


PACKAGE = Path(__file__).parents[1]


def subpackages() -> list[str]:
    """The names of the subpackages of swgsim."""
    return sorted(path.parent.name for path in PACKAGE.glob("*/__init__.py"))


@cache
def code_version(*also: str) -> str:
    """Version of the package, with a digest of the sources that recordings depend on, and of other subpackages.

    Parameters
    ----------
    also : str
        Further subpackages of swgsim, such as "identification".

    Raises
    ------
    ValueError
        If a subpackage is unknown; the message lists the choices.
    """
    require_known("code_version", also, subpackages())
    digest = hashlib.sha256()
    for subpackage in sorted({*MAKING, *also}):
        for source in sorted((PACKAGE / subpackage).rglob("*.py")):
            digest.update(source.read_bytes())
    return f"{version('swg-workbench')}+{digest.hexdigest()[:12]}"


__version__ = version("swg-workbench")


def version_text() -> str:
    """Name and version of the distribution.

    >>> version_text().split()[0]
    'swg-workbench'
    """
    return f"swg-workbench {__version__}"
