"""A commissioned unit as one HDF5 file, from which answers are the same to the last bit.

The file follows the fields of :class:`~swgsim.identification.fit.unit.Unit` (:mod:`swgsim.storage.dataclass_tree`).
Nothing in it is run: effects are names with parameters, and one of a user's own must be imported already. The
first 512 bytes seal the rest by its SHA-256.
"""

import json
import sys
from pathlib import Path
from typing import TypeVar

from swgsim.common.files import replacing
from swgsim.common.version import __version__
from swgsim.effects.base import Effect
from swgsim.effects.text import entries, from_entries
from swgsim.storage.attributes import attribute, set_attributes
from swgsim.storage.dataclass_tree import Notation, Room, layout_of, read_member, write_member
from swgsim.storage.hdf5_reader import opened
from swgsim.storage.hdf5_writer import created
from swgsim.storage.storage import SEAL_SIZE, is_sealed, seal, verify

T = TypeVar("T")
WHAT, AGAIN = "unit", "commission the unit again (swg commission)"
# Of the format. Raise it where fields keep their names and get another meaning; changed fields are seen without it.
VERSION = 1


def write_unit(path: Path, unit: object) -> None:
    """Write a unit; the file is complete or absent, and the same unit gives the same bytes.

    Raises
    ------
    OSError
        If the disk is full or the folder cannot be written; the message names the remedy.
    ValueError
        If an effect cannot be written as text.
    """
    with replacing(path) as aside:
        with created(aside, SEAL_SIZE) as (file, _):
            set_attributes(file, version=_version(type(unit)), swgsim=__version__)
            write_member(file, WHAT, unit, type(unit), EFFECTS)
        seal(aside, WHAT)


def read_unit(path: Path, kind: type[T]) -> T:
    """Read a unit.

    Parameters
    ----------
    path : Path
    kind : type
        The class of units.

    Raises
    ------
    ValueError
        If the file is missing, damaged, no unit, or of another version of the format; the message has the file, the
        field, what was found and what was expected.
    """
    if not path.is_file():
        raise ValueError(f"{path}: no such file, expected a unit; {AGAIN}")
    verify(path, WHAT, AGAIN)
    try:
        with opened(path) as file:
            found, by = str(attribute(file, "version"))[:80], str(attribute(file, "swgsim"))[:80]
            if found != _version(kind):
                raise ValueError(
                    f"found version {found} of the format, written by swgsim {by}, expected {_version(kind)} of swgsim "
                    f"{__version__}"
                )
            unit: T = read_member(file, WHAT, kind, Room(path.stat().st_size), EFFECTS)
            return unit
    # The library raises errors of many kinds for damaged bytes; anybody can seal those.
    except (OSError, RuntimeError, LookupError, TypeError, ValueError) as error:
        raise ValueError(f"{path}: {error}; {AGAIN}") from error


def is_unit_file(path: Path) -> bool:
    """Whether a path is a file of a unit, by its first bytes."""
    return is_sealed(path, WHAT)


def _version(kind: type) -> str:
    return f"{VERSION}-{layout_of(kind, EFFECTS)}"


def _text(effect: Effect) -> str:
    """An effect as its name and parameters, like an entry of ``effects.yaml``; numbers are exact."""
    (entry,) = entries([effect])
    return json.dumps(entry)


def _effect(text: str) -> Effect:
    """The effect of a text; a file imports nothing."""
    try:
        entry = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"found {text[:80]!r}, expected an effect ({error})") from error
    for name in entry if isinstance(entry, dict) else ():
        module = name.rpartition(":")[0]
        if module and module not in sys.modules:
            raise ValueError(
                f"found the effect {name[:80]!r}, whose module is not imported, expected one of the library: import "
                f"{module[:80]} before, by library=[{name[:80]}] on the command line"
            )
    (effect,) = from_entries([entry])
    return effect


EFFECTS = (Notation(Effect, _text, _effect),)
