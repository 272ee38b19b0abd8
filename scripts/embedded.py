"""Exported methods beside one another: python scripts/embedded.py (docs/embedded.md)"""

import hydra
from misspelt import answered
from omegaconf import DictConfig

from swgsim.common.configured import plain


@hydra.main(version_base="1.3", config_path="../conf", config_name="embedded")
def main(config: DictConfig) -> None:
    """Resolve the configuration and run the job."""
    from learn.embedded.report import run

    run(plain(config))


if __name__ == "__main__":
    answered(main, "embedded")
