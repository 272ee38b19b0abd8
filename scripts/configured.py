"""A configuration of Hydra as the plain values that jobs take."""

from typing import Any

from omegaconf import DictConfig, OmegaConf

# Choices that are names of files and folders, or patterns of them.
NAMES = {"blind", "commissioning", "commissioning_mapping", "data", "docs", "embedded", "folder", "holdout", "mapping"}
NAMES |= {"model", "models", "out", "recordings", "report", "truth", "without"}


def plain(config: DictConfig) -> dict[str, Any]:
    """The resolved choices; a name that is a number, as of the folder in recordings=12, is a name all the same."""
    resolved: dict[str, Any] = OmegaConf.to_container(config, resolve=True)  # type: ignore[assignment]
    numbers = {name: resolved[name] for name in NAMES & resolved.keys() if type(resolved[name]) in (int, float)}
    return resolved | {name: str(number) for name, number in numbers.items()}
