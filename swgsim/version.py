"""Which code made a result."""

import hashlib
from functools import cache
from importlib.metadata import version
from pathlib import Path

from swgsim.checks import require_known

# Modules that only show, check or question what the others make: a new caption is no new data set.
SHOWING = (
    "benchmark.py",
    "claims.py",
    "convergence.py",
    "direct.py",
    "effect_gallery.py",
    "effect_signature.py",
    "examples.py",
    "figures.py",
    "finding.py",
    "flexspline_figures.py",
    "orders.py",
    "page.py",
    "record_job.py",
    "stiffness.py",
    "style.py",
    "truth.py",
    "virtual_bench.py",
)
# Packages of such modules.
SHOWING_PACKAGES = ("blind", "defects", "intake", "joint", "loop", "oracle")


@cache
def code_version(*also: str) -> str:
    """Version of the package, with a digest of the sources that recordings depend on, and of others.

    Parameters
    ----------
    also : str
        Packages and modules of those that only show or question, such as "loop" or "virtual_bench.py".

    Raises
    ------
    ValueError
        If there is no such package or module; it lists the choices.
    """
    require_known("code_version", also, (*SHOWING, *SHOWING_PACKAGES))
    digest = hashlib.sha256()
    folder = Path(__file__).parent
    for source in sorted(folder.rglob("*.py")):
        place = source.relative_to(folder).parts[0]
        if place in also or (place not in SHOWING and place not in SHOWING_PACKAGES):
            digest.update(source.read_bytes())
    return f"{version('swg-workbench')}+{digest.hexdigest()[:12]}"
