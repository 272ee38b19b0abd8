"""Objects of dataclasses from mappings, such as those of YAML files."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, TypeVar

from swgsim.common.checks import require_known

T = TypeVar("T")


def build(kind: type[T], config: Mapping[str, Any], **given: Any) -> T:
    """An object of a dataclass from a mapping; lists become tuples.

    Raises
    ------
    ValueError
        If the mapping has a key that the class does not know; it lists the choices.
    """
    require_known(kind.__name__, config, [f.name for f in fields(kind)])  # type: ignore[arg-type]
    values = {key: tuple(value) if isinstance(value, list) else value for key, value in config.items()}
    return kind(**(values | given))
