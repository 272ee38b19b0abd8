"""The blind test of the loop: python scripts/blind.py [cases=20] [seed=5]"""

import hydra
from misspelt import answered
from omegaconf import DictConfig

from swgsim.blind.blind_study import run
from swgsim.common.configured import plain


@hydra.main(version_base="1.3", config_path="../conf", config_name="blind")
def main(config: DictConfig) -> None:
    """Resolve the configuration and run the job."""
    run(plain(config))


if __name__ == "__main__":
    answered(main, "blind")
