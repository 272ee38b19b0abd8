"""Which code made a result."""

import hashlib
from functools import cache
from importlib.metadata import version
from pathlib import Path


@cache
def code_version() -> str:
    """Version of the package, with a digest of its sources so that no change goes unnoticed."""
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.rglob("*.py")):
        digest.update(source.read_bytes())
    return f"{version('swg-workbench')}+{digest.hexdigest()[:12]}"
