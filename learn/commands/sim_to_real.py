"""The command ``swg sim-to-real``."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any


def run(config: Mapping[str, Any]) -> None:
    """Study every undeclared effect and write ``sim_to_real.html`` and ``sim_to_real.json``."""
    from learn.jobs import settings
    from learn.sim_to_real.report import write
    from learn.sim_to_real.sim_to_real_study import STUDY, study_all

    store = settings.store({**config["tracking"], "experiment": STUDY})
    write(study_all(config, store), Path(config["out"]))
