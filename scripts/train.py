"""Train and judge classifiers: one job, a sweep with -m, or an experiment such as experiment=table7."""

import hydra
from misspelt import answered
from omegaconf import DictConfig, OmegaConf


@hydra.main(version_base="1.3", config_path="../conf", config_name="train")
def main(config: DictConfig) -> float:
    """One job of ``conf/train.yaml``; its test score [%]."""
    from learn.job import run

    return run(OmegaConf.to_container(config, resolve=True))["test_score"]  # type: ignore[arg-type]


if __name__ == "__main__":
    answered(main, "train")
