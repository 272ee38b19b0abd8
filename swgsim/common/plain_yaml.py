"""YAML with plain data only: without tags that make objects, aliases and repeated keys."""

from typing import Any

import yaml


class PlainLoader(yaml.SafeLoader):
    """Loader that refuses aliases, which can make a short file very long, and repeated keys, of which one is lost."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        if self.check_event(yaml.AliasEvent):
            raise yaml.YAMLError("an alias such as *name: write the values out")
        return super().compose_node(parent, index)

    def construct_mapping(self, node: Any, deep: bool = False) -> dict:
        keys = [self.construct_object(key, deep=True) for key, _ in node.value]
        made = super().construct_mapping(node, deep)
        if len(made) < len(keys):
            twice = next(key for i, key in enumerate(keys) if key in keys[:i])
            raise yaml.YAMLError(f"the key {str(twice)[:60]!r} twice: keep one")
        return made


def plain(text: str | bytes, loader: type[PlainLoader] = PlainLoader) -> Any:
    """The data of a text.

    Raises
    ------
    ValueError
        If it is not YAML, or not only plain data.
    """
    try:
        return yaml.load(text, loader)  # derived from the safe one
    # An invalid date and an integer with too many digits raise errors that are not those of YAML.
    except (yaml.YAMLError, RecursionError, ValueError, OverflowError, TypeError) as error:
        raise ValueError(f"no YAML: {error or 'nested too deep'}") from error
