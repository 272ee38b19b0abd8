"""A trained classifier as C or ONNX: python scripts/export.py classifier=extra_trees features=harmonics target=c"""

import hydra
from misspelt import answered
from omegaconf import DictConfig

from swgsim.common.configured import plain


@hydra.main(version_base="1.3", config_path="../conf", config_name="export")
def main(config: DictConfig) -> None:
    """Resolve the configuration and run the job."""
    from learn.embedded.export_job import run

    run(plain(config))


if __name__ == "__main__":
    answered(main, "export")
