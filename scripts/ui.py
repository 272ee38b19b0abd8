"""Serve MLflow's page on this machine and print links to the tables of scores and to all other experiments."""

import hydra
from misspelt import answered
from omegaconf import DictConfig, OmegaConf


@hydra.main(version_base="1.3", config_path="../conf", config_name="ui")
def main(config: DictConfig) -> None:
    """Serve until interrupted."""
    from learn.jobs.settings import store
    from learn.tracking.ui import serve

    serve(store(OmegaConf.to_container(config.tracking)), config.host, config.port)  # type: ignore[arg-type]


if __name__ == "__main__":
    answered(main, "ui")
