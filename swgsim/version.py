"""Which code made a result."""

import hashlib
from functools import cache
from importlib.metadata import version
from pathlib import Path

# Modules that only show, check or question what the others make: a new caption is no new data set.
SHOWING = (
    "assembly.py",
    "benchmark.py",
    "claims.py",
    "convergence.py",
    "csv_table.py",
    "direct.py",
    "effect_gallery.py",
    "examples.py",
    "facts.py",
    "figures.py",
    "finding.py",
    "flexspline_figures.py",
    "folder.py",
    "foreign.py",
    "manifest.py",
    "oracle.py",
    "oracle_cells.py",
    "oracle_job.py",
    "oracle_model.py",
    "oracle_point.py",
    "order_2.py",
    "orders.py",
    "page.py",
    "reading.py",
    "reading_limits.py",
    "record_job.py",
    "recording_file.py",
    "source_map.py",
    "sources.py",
    "speed_units.py",
    "stiffness.py",
    "style.py",
    "thresholds.py",
    "truth.py",
    "units.py",
    "virtual_bench.py",
)
# Parts of names of such modules, and folders of them.
SHOWING_ALIKE = ("defect", "loop", "blind")


@cache
def code_version() -> str:
    """Version of the package, with a digest of the sources that recordings depend on."""
    digest = hashlib.sha256()
    folder = Path(__file__).parent
    for source in sorted(folder.rglob("*.py")):
        name = str(source.relative_to(folder))
        if source.name not in SHOWING and not any(part in name for part in SHOWING_ALIKE):
            digest.update(source.read_bytes())
    return f"{version('swg-workbench')}+{digest.hexdigest()[:12]}"
