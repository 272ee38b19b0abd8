"""Serve the runs of a team: MLflow in front of PostgreSQL, until interrupted."""

from pathlib import Path

import hydra
from misspelt import answered
from omegaconf import DictConfig


@hydra.main(version_base="1.3", config_path="../conf", config_name="server")
def main(config: DictConfig) -> None:
    """Serve until interrupted."""
    from learn.tracking.server import serve_team

    try:
        serve_team(Path(config.folder), config.host, config.port, config.workers, config.allowed_hosts)
    except (ValueError, RuntimeError, OSError) as error:
        raise SystemExit(str(error)) from error


if __name__ == "__main__":
    answered(main, "server")
