"""Generate a data set: python scripts/generate.py grid=paper condition=clean"""

import hydra
from misspelt import answered
from omegaconf import DictConfig

from swgsim.common.configured import plain
from swgsim.jobs.generate_data_set import run


@hydra.main(version_base="1.3", config_path="../conf", config_name="generate")
def main(config: DictConfig) -> None:
    """Resolve the configuration and run the job."""
    run(plain(config))


if __name__ == "__main__":
    answered(main, "generate")
