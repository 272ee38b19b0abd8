"""The command ``swg train``."""

from collections.abc import Mapping
from typing import Any


def run(config: Mapping[str, Any]) -> float:
    """One job of ``conf/train.yaml``; its test score [%], which a sweep of Hydra may optimise."""
    from learn.jobs.train_job import run as train

    return train(config)["test_score"]
