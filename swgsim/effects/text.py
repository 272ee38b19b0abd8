"""Effects as text: users write them, and the identification returns them.

A list with one entry for each effect: its registered name and its parameters. An effect from outside this project has
its import path ``module:Class`` as name::

    effects:
    - eccentric_wave_generator: {r: 1.0e-5, theta: 1.0}
    - my_module:MyEffect: {size: 2.0}
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, Field, fields
from typing import Any

import numpy as np
import yaml

from swgsim.common.plain_yaml import PlainLoader, plain
from swgsim.effects.base import Effect
from swgsim.effects.library import LIBRARY, named
from swgsim.effects.one_gauge import ALL
from swgsim.effects.quantity import Role, quantities, size_of

EXAMPLE = "{eccentric_wave_generator: {r: 1.0e-5, theta: 1.0}}"


class _Loader(PlainLoader):
    """Reads 1e-5 as a number, as YAML 1.2 does; PyYAML needs 1.0e-5."""


class _Dumper(yaml.SafeDumper):
    """Quotes text that the loader would read as a number."""


for _side in (_Loader, _Dumper):
    _side.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"[-+]?\d+[eE][-+]?\d+$"), list("-+0123456789"))


def as_text(effects: Sequence[Effect]) -> str:
    """The effects as YAML, from which :func:`from_text` makes equal ones."""
    return yaml.dump({"effects": entries(effects)}, Dumper=_Dumper, sort_keys=False, default_flow_style=None, width=120)


def from_text(text: str, origin: str) -> tuple[Effect, ...]:
    """Effects from YAML.

    Parameters
    ----------
    text : str
    origin : str
        Name of the source, for messages.

    Raises
    ------
    ValueError
        If it is not a list of effects, or one of them is invalid.
    """
    try:
        found = plain(text, _Loader)
    except ValueError as error:
        raise ValueError(f"{origin} is {error}") from error
    if not (isinstance(found, dict) and set(found) == {"effects"} and isinstance(found["effects"], list)):
        raise ValueError(f"{origin} holds no list of effects; it must look like 'effects: [{EXAMPLE}]'")
    try:
        return from_entries(found["effects"])
    except ValueError as error:
        raise ValueError(f"{origin}: {error}") from error


def entries(effects: Sequence[Effect]) -> list[dict[str, dict[str, Any]]]:
    """One mapping for each effect, of plain numbers and text."""
    return [
        {path_of(type(effect)): {f.name: _plain(getattr(effect, f.name)) for f in fields(effect) if f.init}}
        for effect in effects
    ]


def from_entries(given: Sequence[Any]) -> tuple[Effect, ...]:
    """The effects of such mappings.

    Raises
    ------
    ValueError
        If an effect or a parameter is unknown, missing or beyond its bounds; it lists the choices.
    """
    return tuple(_effect(number, entry) for number, entry in enumerate(given, 1))


def path_of(kind: type[Effect]) -> str:
    """The registered name of an effect, or the import path of one from outside the library.

    Raises
    ------
    ValueError
        If the effect cannot be imported.
    """
    if LIBRARY.get(kind.name()) is kind:
        return kind.name()
    if kind.__module__ == "__main__" or "." in kind.__qualname__:
        raise ValueError(
            f"effect {kind.__qualname__} of {kind.__module__} cannot be written as text, as nothing can import it "
            "again: define it at the top of a module of its own"
        )
    return f"{kind.__module__}:{kind.__qualname__}"


def in_words(effect: Effect) -> str:
    """An effect in words, with its size, and its gauge if it has one."""
    name = size_of(type(effect))
    unit = quantities(type(effect))[name].unit
    sensor = getattr(effect, "sensor", None)
    of = "" if sensor is None else " of all gauges" if sensor == ALL else f" of s{sensor}"
    return f"{effect.title()}{of} ({sized(name, format(getattr(effect, name), '.3g'), unit)})"


def sized(name: str, value: str, unit: str) -> str:
    """A parameter in words; a share has no unit."""
    return f"{name.replace('_', ' ')} {value}" + ("" if unit == "-" else f" {unit}")


def _effect(number: int, entry: Any) -> Effect:
    """The effect of one entry."""
    if not (isinstance(entry, Mapping) and len(entry) == 1):
        raise ValueError(f"effect {number} is {entry!r}, must be one name with its parameters, such as {EXAMPLE}")
    ((name, parameters),) = entry.items()
    kind = named(str(name))
    parameters = {} if parameters is None else parameters
    known = {f.name: f for f in fields(kind) if f.init}
    choices = "; ".join(map(_choice, known.values())) or "none"
    if not isinstance(parameters, Mapping):
        raise ValueError(f"parameters of {name} are {parameters!r}, must be a mapping; its parameters are {choices}")
    for parameter in parameters:
        if parameter not in known:
            raise ValueError(f"unknown parameter {parameter!r} of {name}; its parameters are {choices}")
    needed = [f.name for f in known.values() if f.default is MISSING and f.default_factory is MISSING]
    missing = [parameter for parameter in needed if parameter not in parameters]
    if missing:
        raise ValueError(f"{name} has no {', '.join(missing)}; its parameters are {choices}")
    return kind(**{key: tuple(value) if isinstance(value, list) else value for key, value in parameters.items()})


def _choice(parameter: Field) -> str:
    """A parameter in words, with its unit and bounds."""
    quantity = parameter.metadata.get("quantity")
    if quantity is None:
        return parameter.name
    if quantity.role is Role.CHOICE:
        if quantity.among:
            return f"{parameter.name} [{quantity.unit}], one of {', '.join(f'{each:g}' for each in quantity.among)}"
        return f"{parameter.name}, an integer from {quantity.low:g} to {quantity.high:g}"
    if quantity.role in (Role.PHASE, Role.ANGLE, Role.RANDOM):
        return f"{parameter.name} [rad]"
    return f"{parameter.name} [{quantity.unit}] from {quantity.low:g} to {quantity.high:g}"


def _plain(value: Any) -> Any:
    """A value without NumPy's types, which YAML does not know."""
    if isinstance(value, np.generic):
        return value.item()
    return [_plain(each) for each in value] if isinstance(value, tuple) else value
