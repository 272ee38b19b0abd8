"""What makes two jobs the same: their configuration, their data and the code that judges it."""

import hashlib
import json
from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from swgsim import orders

# Parts of a configuration that no result depends on.
WHEREABOUTS = ("data", "models", "tracking", "workers", "compute", "scheduler")
PRESENTATION = (  # modules that only show results, beside the packages tracking and transfer_report
    "bootstrap.py",
    "calibration.py",
    "choices.py",
    "claims.py",
    "decisions.py",
    "detection.py",
    "detection_curve.py",
    "feature_claims.py",
    "figures.py",
    "importance.py",
    "page.py",
    "paper.py",
    "report.py",
    "report_job.py",
    "selective.py",
    "training_benchmark.py",
)


def decisive(config: Mapping[str, Any]) -> dict[str, Any]:
    """The part of a configuration that results depend on."""
    return {key: value for key, value in config.items() if key not in WHEREABOUTS}


def job_key(config: Mapping[str, Any], data_digest: str) -> str:
    """Sixteen hexadecimal digits that change when the result of a job may change."""
    text = json.dumps([decisive(config), data_digest, code_version()], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


@cache
def code_version() -> str:
    """Digest of the sources of this package, but for those that only show results, and of the libraries below it."""
    digest = hashlib.sha256()
    for library in ("numpy", "scipy", "pandas", "scikit-learn", "torch"):
        digest.update(f"{library} {version(library)}".encode())
    sources = [source for source in Path(__file__).parent.glob("*.py") if source.name not in PRESENTATION]
    # The one module of swgsim that is no part of a recording's making, which the data set's own version covers.
    for source in [*sorted(sources), Path(orders.__file__)]:
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def flat(config: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """A nested configuration as one level of dotted names; ``name`` stands for its group.

    >>> flat({"grid": "small", "classifier": {"name": "rf", "trees": 100}})
    {'grid': 'small', 'classifier': 'rf', 'classifier.trees': 100}
    """
    result: dict[str, Any] = {}
    for key, value in config.items():
        name = prefix.removesuffix(".") if prefix and key == "name" else prefix + key
        result |= flat(value, f"{name}.") if isinstance(value, Mapping) else {name: value}
    return result
