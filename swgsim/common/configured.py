"""A configuration of Hydra as the plain values that jobs take."""

from typing import Any

from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig, OmegaConf

# Choices that are names of files and folders, or patterns of them.
NAMES = {"blind", "commissioning", "commissioning_mapping", "data", "docs", "embedded", "folder", "holdout", "mapping"}
NAMES |= {"model", "models", "only", "out", "recordings", "report", "truth", "without"}


def plain(config: DictConfig) -> dict[str, Any]:
    """The resolved choices; a name that Hydra reads as a number, as in recordings=2024_10, is as it was written."""
    resolved: dict[str, Any] = OmegaConf.to_container(config, resolve=True)  # type: ignore[assignment]
    words = HydraConfig.get().overrides.task if HydraConfig.initialized() else []
    written = dict(word.split("=", 1) for word in words if "=" in word)
    numbers = {name: resolved[name] for name in NAMES & resolved.keys() if type(resolved[name]) in (int, float)}
    return resolved | {name: written.get(name, str(number)).strip() for name, number in numbers.items()}
