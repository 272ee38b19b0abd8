"""The command ``swg ui``."""

from collections.abc import Mapping
from typing import Any


def run(config: Mapping[str, Any]) -> None:
    """Serve MLflow's page on this machine until interrupted."""
    from learn.jobs.settings import store
    from learn.tracking.ui import serve

    serve(store(config["tracking"]), config["host"], config["port"])
