"""The floor of the error: what an oracle says of a data set: python scripts/oracle.py grid=sampled condition=bench"""

import hydra
from misspelt import answered
from omegaconf import DictConfig

from swgsim.common.configured import plain
from swgsim.oracle.oracle_study import run


@hydra.main(version_base="1.3", config_path="../conf", config_name="oracle")
def main(config: DictConfig) -> None:
    """Resolve the configuration and run the job."""
    run(plain(config))


if __name__ == "__main__":
    answered(main, "oracle")
