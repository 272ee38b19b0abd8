"""Values of dataclasses in HDF5: names, numbers, texts and arrays only, so that reading a file runs nothing of it.

The annotations of the fields say what is written and what must be found. A dataclass, a mapping or a tuple is a group
with one member for each field, key or number. A number or a text is an attribute, an array is a variable, and what is
None is absent. Values of some classes, such as effects, are texts in a notation of their own.
"""

import hashlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

import h5py
import numpy as np
from jaxtyping import AbstractArray

from swgsim.storage.attributes import attribute, set_attributes

# Room that every member takes at least [bytes], so that a forged file cannot name one member very many times.
LEAST_BYTES = 8
# Whether the axes of a variable are reversed. Matrix products round by the order in memory, so it is kept.
TRANSPOSED = "transposed"
# What an attribute of each of these types is in a file.
NUMBERS: Mapping[type, str] = {float: "f8", int: "i8", bool: "i1"}


@dataclass(frozen=True)
class Notation:
    """How values of a class are written as text.

    Attributes
    ----------
    kind : type
        The class; its subclasses have the same notation.
    write : callable
        The text of a value.
    read : callable
        The value of a text. It raises a ValueError for a text that is none.
    """

    kind: type
    write: Callable[[Any], str]
    read: Callable[[str], Any]


class Room:
    """Bytes of a file that no number has taken yet. More numbers than a file has bytes would fill the memory."""

    def __init__(self, size: int) -> None:
        self.left = size

    def take(self, where: str, size: int) -> None:
        """Take the bytes of one member.

        Raises
        ------
        ValueError
            If the file has no room for it.
        """
        self.left -= max(size, LEAST_BYTES)
        if self.left < 0:
            raise ValueError(f"{where}: found more numbers than the file has room for, expected each number once")


def write_member(group: h5py.Group, name: str, value: Any, kind: Any, notations: tuple[Notation, ...] = ()) -> None:
    """Write one value under a name.

    Parameters
    ----------
    group : Group
    name : str
    value : object
    kind : type
        Its annotation.
    notations : tuple of Notation
        Of classes that are written as text.

    Raises
    ------
    TypeError
        If values of this annotation have no form in a file.
    """
    kind = _required(kind)
    if value is None:
        return
    notation = _notation(kind, notations)
    if notation:
        set_attributes(group, **{name: notation.write(value)})
    elif kind is str:
        set_attributes(group, **{name: value})
    elif kind in NUMBERS:
        group.attrs.create(name, value, dtype=NUMBERS[kind])
    elif _is_array(kind):
        transposed = value.flags.f_contiguous and not value.flags.c_contiguous
        variable = group.create_dataset(name, data=np.ascontiguousarray(value.T if transposed else value))
        if transposed:
            set_attributes(variable, **{TRANSPOSED: 1})
    else:
        below = group.create_group(name, track_order=True)  # tuples and mappings keep their order
        for key, (each, own) in _members(kind, value).items():
            write_member(below, key, each, own, notations)


def read_member(group: h5py.Group, name: str, kind: Any, room: Room, notations: tuple[Notation, ...] = ()) -> Any:
    """Read the value of an annotation that :func:`write_member` wrote under a name.

    Raises
    ------
    ValueError
        If something else is found; the message has the field, what was found and what was expected.
    """
    where = f"{group.name.rstrip('/')}/{name}".lstrip("/").replace("/", ".")
    needed = _required(kind)
    if name not in group and name not in group.attrs:
        if needed is kind:
            raise ValueError(f"{where}: found nothing, expected {_in_words(kind)}")
        return None
    notation = _notation(needed, notations)
    if notation or needed is str or needed in NUMBERS:
        return _read_attribute(group, name, where, needed, room, notation)
    variable = group[name] if isinstance(group.get(name, getlink=True), h5py.HardLink) else None
    if _is_array(needed):
        return _read_array(variable, where, needed, room)
    if not isinstance(variable, h5py.Group):
        raise ValueError(f"{where}: found no group of the file itself, expected {_in_words(needed)}")
    room.take(where, LEAST_BYTES)
    return _read_group(variable, where, needed, room, notations)


def layout_of(kind: Any, notations: tuple[Notation, ...] = ()) -> str:
    """Digest of the names and types of all fields, which changes when one of them does."""
    lines = "\n".join(_described(kind, "", notations))
    return hashlib.sha256(lines.encode()).hexdigest()[:16]


def _described(kind: Any, path: str, notations: tuple[Notation, ...]) -> Iterator[str]:
    needed = _required(kind)
    yield f"{path}: {_in_words(needed)}{'' if needed is kind else ' or nothing'}"
    if _notation(needed, notations):
        return
    if _has_fields(needed):
        for name, own in _annotations(needed).items():
            yield from _described(own, f"{path}.{name}", notations)
    elif get_origin(needed) is not None and not _is_array(needed):
        for own in get_args(needed):
            if own is not Ellipsis:
                yield from _described(own, f"{path}[]", notations)


def _members(kind: Any, value: Any) -> dict[str, tuple[Any, Any]]:
    """The members of a dataclass, a mapping or a tuple by name, each with its annotation."""
    if _has_fields(kind):
        return {name: (getattr(value, name), own) for name, own in _annotations(kind).items()}
    if _is_mapping(kind):
        own = get_args(kind)[1]
        return {key: (each, own) for key, each in value.items()}
    if get_origin(kind) is tuple:
        kinds = _of_tuple(kind, len(value))
        return {str(number): member for number, member in enumerate(zip(value, kinds, strict=True))}
    raise TypeError(f"{kind} has no form in a file: use dataclasses, mappings from str, tuples, arrays, numbers, texts")


def _read_group(group: h5py.Group, where: str, kind: Any, room: Room, notations: tuple[Notation, ...]) -> Any:
    """A dataclass, a mapping or a tuple."""
    # Attributes and links are counted apart; each keeps its order.
    found = [*group.attrs, *group]
    if _has_fields(kind):
        own = _annotations(kind)
        unknown = [name for name in found if name not in own]
        if unknown:
            raise ValueError(f"{where}: found {unknown[0]!r}, expected one of {', '.join(own)}")
        values = {name: read_member(group, name, each, room, notations) for name, each in own.items()}
        try:
            return kind(**values)
        except (TypeError, ValueError) as error:
            raise ValueError(f"{where}: {error}") from error
    if _is_mapping(kind):
        return {name: read_member(group, name, get_args(kind)[1], room, notations) for name in found}
    names = [str(number) for number in range(len(found))]
    if sorted(found) != sorted(names):
        raise ValueError(f"{where}: found members {', '.join(found)[:80]}, expected numbers from 0 on")
    kinds = _of_tuple(kind, len(names), where)
    return tuple(read_member(group, name, each, room, notations) for name, each in zip(names, kinds, strict=True))


def _read_attribute(group: h5py.Group, name: str, where: str, kind: type, room: Room, notation: Notation | None) -> Any:
    """A number, or a text."""
    expected = f"expected {_in_words(kind)}"
    try:
        value = attribute(group, name)
    except KeyError:
        raise ValueError(f"{where}: found no attribute, {expected}") from None
    except ValueError as error:
        raise ValueError(f"{where}: found an {error}") from error
    room.take(where, len(value) if isinstance(value, str) else LEAST_BYTES)
    if kind in NUMBERS:
        whole = kind is float or isinstance(value, int)
        if isinstance(value, str) or not whole or not np.isfinite(value) or (kind is bool and value not in (0, 1)):
            raise ValueError(f"{where}: found {str(value)[:80]!r}, {expected}")
        return kind(value)
    if not isinstance(value, str):
        raise ValueError(f"{where}: found {value!r}, {expected}")
    try:
        return notation.read(value) if notation else value
    except ValueError as error:
        raise ValueError(f"{where}: {error}") from error


def _read_array(variable: Any, where: str, kind: Any, room: Room) -> np.ndarray:
    """An array of the type and the number of axes of its annotation, all of whose numbers are in the file itself."""
    expected = f"expected {_in_words(kind)}"
    if not isinstance(variable, h5py.Dataset) or variable.is_virtual or variable.external:
        raise ValueError(f"{where}: found no variable of the file itself, {expected}")
    transposed = TRANSPOSED in variable.attrs
    shape, dtype = (variable.shape or ())[:: -1 if transposed else 1], variable.dtype
    room.take(where, (variable.size or 0) * dtype.itemsize)
    if dtype.kind not in "fiubc" or not isinstance(np.empty(shape, dtype), kind):
        raise ValueError(f"{where}: found {dtype} of shape {shape}, {expected}")
    values = np.asarray(variable[()])
    if values.dtype.kind in "fc" and not np.isfinite(values).all():
        raise ValueError(f"{where}: found a value that is not finite, {expected}")
    return values.T if transposed else values


def _required(kind: Any) -> Any:
    """An annotation without None."""
    if get_origin(kind) in (Union, UnionType):
        (kind,) = [each for each in get_args(kind) if each is not NoneType]
    return kind


def _notation(kind: Any, notations: tuple[Notation, ...]) -> Notation | None:
    return next((each for each in notations if isinstance(kind, type) and issubclass(kind, each.kind)), None)


def _has_fields(kind: Any) -> bool:
    """Whether an annotation is a dataclass."""
    return is_dataclass(kind)


def _annotations(kind: Any) -> dict[str, Any]:
    """The annotations of the fields of a dataclass."""
    hints = get_type_hints(kind)
    return {field.name: hints[field.name] for field in fields(kind) if field.init}


def _is_array(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, AbstractArray | np.ndarray)


def _is_mapping(kind: Any) -> bool:
    return isinstance(get_origin(kind), type) and issubclass(get_origin(kind), Mapping) and get_args(kind)[0] is str


def _of_tuple(kind: Any, length: int, where: str = "") -> list[Any]:
    """The annotation of every member of a tuple."""
    kinds = list(get_args(kind))
    if len(kinds) == 2 and kinds[1] is Ellipsis:
        return [kinds[0]] * length
    if len(kinds) != length:
        raise ValueError(f"{where}: found {length} members, expected {len(kinds)}")
    return kinds


def _in_words(kind: Any) -> str:
    """An annotation for a message."""
    return kind.__name__ if isinstance(kind, type) and get_origin(kind) is None else str(kind)
