"""Write the report of the transfer study from its runs: python scripts/transfer_report.py [grid=gears]"""

import hydra
from misspelt import answered
from omegaconf import DictConfig

from swgsim.common.configured import plain


@hydra.main(version_base="1.3", config_path="../conf", config_name="transfer_report")
def main(config: DictConfig) -> None:
    """Resolve the configuration and write the report."""
    from learn.transfer_report.transfer_study import run

    run(plain(config))


if __name__ == "__main__":
    answered(main, "transfer_report")
