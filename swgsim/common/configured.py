"""Where the configuration lies, and a configuration of Hydra as the plain values that jobs take."""

from pathlib import Path
from typing import Any

from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig, OmegaConf

# Choices that are names of files and folders, or patterns of them.
NAMES = {"blind", "commissioning", "commissioning_mapping", "data", "docs", "embedded", "files", "folder", "holdout"}
NAMES |= {"mapping", "model", "models", "only", "out", "recordings", "report", "truth", "without"}


def conf_folder() -> Path:
    """The folder ``conf/``: that of a wheel lies in the package, that of a checkout beside it.

    >>> (conf_folder() / "gear" / "gear1.yaml").is_file()
    True
    """
    package = Path(__file__).parents[1]
    packaged = package / "conf"
    return packaged if packaged.is_dir() else package.parent / "conf"


def plain(config: DictConfig) -> dict[str, Any]:
    """The resolved choices; a name that Hydra reads as a number, as in recordings=2024_10, is as it was written."""
    resolved: dict[str, Any] = OmegaConf.to_container(config, resolve=True)  # type: ignore[assignment]
    words = HydraConfig.get().overrides.task if HydraConfig.initialized() else []
    written = dict(word.split("=", 1) for word in words if "=" in word)
    numbers = {name: resolved[name] for name in NAMES & resolved.keys() if type(resolved[name]) in (int, float)}
    return resolved | {name: written.get(name, str(number)).strip() for name, number in numbers.items()}
