"""Identity of a job: its configuration, its data and the code that computes the result."""

import hashlib
import json
from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from learn.methods.contract import own_source_digests
from swgsim.common.version import code_version as version_of_subpackages
from swgsim.storage import orders

# Parts of a configuration that do not change a result.
WHEREABOUTS = ("data", "models", "tracking", "workers", "compute", "scheduler")
# The subpackages that the score of a job depends on.
DECISIVE = ("adaptation", "evaluation", "inputs", "jobs", "methods", "protocols")


def decisive(config: Mapping[str, Any]) -> dict[str, Any]:
    """The part of a configuration that results depend on."""
    return {
        key: decisive(value) if isinstance(value, Mapping) else value
        for key, value in config.items()
        if key not in WHEREABOUTS
    }


def job_key(config: Mapping[str, Any], data_digest: str) -> str:
    """Sixteen hexadecimal digits that change when the result of a job may change."""
    code = [code_version(), *own_source_digests(config), *_physics(config)]
    text = json.dumps([decisive(config), data_digest, *code], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _physics(config: Mapping[str, Any]) -> list[str]:
    """Digest of the subpackages of swgsim that a twin needs, as it simulates; empty for all other classifiers."""
    is_twin = config.get("classifier", {}).get("name") in ("twin", "fast_twin")
    return [version_of_subpackages("identification", "oracle", "twin")] if is_twin else []


@cache
def code_version() -> str:
    """Digest of the sources of this package that change scores, and of the versions of its libraries."""
    digest = hashlib.sha256()
    for library in ("numpy", "scipy", "pandas", "scikit-learn", "torch"):
        digest.update(f"{library} {version(library)}".encode())
    folder = Path(__file__).parents[1]
    sources = (source for subpackage in DECISIVE for source in sorted((folder / subpackage).rglob("*.py")))
    # A module of swgsim that only learning uses; the data set's own version covers the others.
    for source in [*sources, Path(orders.__file__)]:
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
