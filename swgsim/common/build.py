"""Objects of dataclasses from mappings, such as those of YAML files."""

from collections.abc import Mapping
from dataclasses import fields
from functools import cache
from typing import Any, TypeVar, cast

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


def replaced(instance: T, **changes: Any) -> T:
    """The same as :func:`dataclasses.replace` for a class without slots and arguments of ``__init__`` alone, faster.

    A data set makes several gears for every recording. The check of ``__post_init__`` is done as ever.

    Raises
    ------
    TypeError
        If there is no such field.
    """
    kind: type = type(instance)
    given, names = vars(instance), _names(kind)
    values = {name: given[name] for name in names} | changes
    if len(values) > len(names):
        raise TypeError(f"{kind.__name__} has no {', '.join(sorted(values.keys() - names))}")
    new: Any = object.__new__(kind)
    vars(new).update(values)
    new.__post_init__()
    return cast(T, new)


@cache
def _names(kind: type) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind))
