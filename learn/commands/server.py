"""The command ``swg server``."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any


def run(config: Mapping[str, Any]) -> None:
    """Serve the runs of a team, MLflow in front of PostgreSQL, until interrupted."""
    from learn.tracking.server import serve_team

    try:
        serve_team(Path(config["folder"]), *(config[key] for key in ("host", "port", "workers", "allowed_hosts")))
    except RuntimeError as error:
        raise SystemExit(str(error)) from error
