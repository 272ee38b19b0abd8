"""Robot joints that were really measured, case by case: python scripts/joints.py [folder=FOLDER] [only=PATTERN]"""

import hydra
from misspelt import answered
from omegaconf import DictConfig

from swgsim.common.configured import plain
from swgsim.joint.cases import run


@hydra.main(version_base="1.3", config_path="../conf", config_name="joints")
def main(config: DictConfig) -> None:
    """Resolve the configuration and run the job."""
    run(plain(config))


if __name__ == "__main__":
    answered(main, "joints")
