"""Write the report from the data sets and the runs of the experiments: python scripts/report.py [grid=paper]"""

import hydra
from misspelt import answered
from omegaconf import DictConfig

from swgsim.common.configured import plain


@hydra.main(version_base="1.3", config_path="../conf", config_name="report")
def main(config: DictConfig) -> None:
    """Resolve the configuration and write the report."""
    from learn.paper.paper_report import run

    run(plain(config))


if __name__ == "__main__":
    answered(main, "report")
