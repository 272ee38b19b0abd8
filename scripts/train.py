"""Train and judge classifiers: one job, a sweep with -m, or an experiment such as experiment=table7."""

import sys

import hydra
from misspelt import answered
from omegaconf import DictConfig

from swgsim.common.configured import plain


@hydra.main(version_base="1.3", config_path="../conf", config_name="train")
def main(config: DictConfig) -> float:
    """One job of ``conf/train.yaml``; its test score [%]."""
    from learn.jobs.train_job import run

    return run(plain(config))["test_score"]


if __name__ == "__main__":
    from learn.methods.contract import with_own_classifier

    sys.argv[1:] = with_own_classifier(sys.argv[1:])
    answered(main, "train")
