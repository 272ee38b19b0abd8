"""Does closing the loop help a classifier? python scripts/sim_to_real.py [grid.variants=32] [~undeclared.coning] ..."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import hydra
from misspelt import answered
from omegaconf import DictConfig

from swgsim.common.configured import plain


def run(config: Mapping[str, Any]) -> None:
    """Study every undeclared effect and write ``sim_to_real.html`` and ``sim_to_real.json``."""
    from learn.jobs import settings
    from learn.sim_to_real.report import write
    from learn.sim_to_real.sim_to_real_study import STUDY, study_all

    store = settings.store({**config["tracking"], "experiment": STUDY})
    write(study_all(config, store), Path(config["out"]))


@hydra.main(version_base="1.3", config_path="../conf", config_name="sim_to_real")
def main(config: DictConfig) -> None:
    """Resolve the configuration and run the study."""
    run(plain(config))


if __name__ == "__main__":
    answered(main, "sim_to_real")
