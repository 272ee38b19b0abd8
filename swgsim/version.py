"""Which code made a result."""

import hashlib
from functools import cache
from importlib.metadata import version
from pathlib import Path

# Modules that only show or check what the others make: a new caption is no new data set.
SHOWING = (
    "benchmark.py",
    "claims.py",
    "convergence.py",
    "direct.py",
    "examples.py",
    "figures.py",
    "finding.py",
    "flexspline_figures.py",
    "oracle.py",
    "oracle_cells.py",
    "oracle_job.py",
    "oracle_model.py",
    "oracle_point.py",
    "orders.py",
    "stiffness.py",
    "style.py",
)


@cache
def code_version() -> str:
    """Version of the package, with a digest of the sources that recordings depend on."""
    digest = hashlib.sha256()
    sources = (source for source in Path(__file__).parent.rglob("*.py") if source.name not in SHOWING)
    for source in sorted(sources):
        digest.update(source.read_bytes())
    return f"{version('swg-workbench')}+{digest.hexdigest()[:12]}"
