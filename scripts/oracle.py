"""The floor of the error: what an oracle says of a data set: python scripts/oracle.py grid=sampled condition=bench"""

import hydra
from misspelt import answered
from omegaconf import DictConfig, OmegaConf

from swgsim.oracle.job import run


@hydra.main(version_base="1.3", config_path="../conf", config_name="oracle")
def main(config: DictConfig) -> None:
    """Resolve the configuration and run the job."""
    run(OmegaConf.to_container(config, resolve=True))  # type: ignore[arg-type]


if __name__ == "__main__":
    answered(main, "oracle")
