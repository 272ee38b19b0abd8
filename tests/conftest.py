"""Shapes and types of the annotations are checked at run time, in tests only."""

import os
from collections.abc import Iterator

os.environ.setdefault("MLFLOW_DISABLE_TELEMETRY", "true")

import jaxtyping
import pytest

jaxtyping.install_import_hook(["swgsim", "learn"], "typechecker.typecheck")


@pytest.fixture(scope="module", autouse=True)
def _end_to_end(request: pytest.FixtureRequest) -> Iterator[None]:
    """Without checks in tests from end to end: the integrator calls small functions a million times.

    The tests of the chain check these.
    """
    with pytest.MonkeyPatch.context() as patch:
        if request.node.get_closest_marker("end_to_end"):
            patch.setattr(jaxtyping.config, "jaxtyping_disable", True)
        yield
