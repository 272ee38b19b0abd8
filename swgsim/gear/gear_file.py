"""The numbers of gear files (conf/gear)."""

from pathlib import Path
from typing import Any

from omegaconf import OmegaConf

from swgsim.common.plain_yaml import plain


def gear_values(path: Path) -> dict[str, Any]:
    """The numbers of a file on top of those of the files that it names under ``defaults``, as Hydra composes them.

    Raises
    ------
    ValueError
        If the file is missing or holds no mapping.
    """
    if not path.is_file():
        raise ValueError("not found: give gear1, gear2 or gear3, or copy conf/gear/gear1.yaml and change its numbers")
    config = plain(path.read_text(encoding="utf-8"))
    if not isinstance(config, dict):
        raise ValueError(f"holds {type(config).__name__}, expected names with values")
    bases = [name for name in config.pop("defaults", []) if name != "_self_"]
    merged = OmegaConf.merge(*(gear_values(path.with_name(f"{name}.yaml")) for name in bases), config)
    return dict(OmegaConf.to_container(merged))  # type: ignore[arg-type]
