"""Recordings from a virtual test bench: python scripts/record.py out=recordings/a hidden=my_effects.yaml"""

import hydra
from misspelt import answered
from omegaconf import DictConfig

from swgsim.common.configured import plain
from swgsim.jobs.record_on_bench import run


@hydra.main(version_base="1.3", config_path="../conf", config_name="record")
def main(config: DictConfig) -> None:
    """Resolve the configuration and run the job."""
    run(plain(config))


if __name__ == "__main__":
    answered(main, "record")
