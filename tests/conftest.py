"""Shapes and types of the annotations are checked at run time, in tests only."""

import gc
import os
from collections.abc import Iterator

os.environ.setdefault("MLFLOW_DISABLE_TELEMETRY", "true")

import jaxtyping
import pytest

jaxtyping.install_import_hook(["swgsim", "learn"], "typechecker.typecheck")


def _unchecked(request: pytest.FixtureRequest) -> Iterator[None]:
    """Without checks in slow tests and those from end to end: they call small functions a million times.

    Other tests check these.
    """
    with pytest.MonkeyPatch.context() as patch:
        if any(request.node.get_closest_marker(name) for name in ("end_to_end", "slow")):
            patch.setattr(jaxtyping.config, "jaxtyping_disable", True)
        yield


# The fixtures of a module that is marked are made before the fixtures of its tests.
_module = pytest.fixture(_unchecked, scope="module", autouse=True)
_test = pytest.fixture(_unchecked, autouse=True)


def pytest_collection_finish() -> None:
    """What is loaded by now is no garbage and need not be searched for it."""
    gc.freeze()
