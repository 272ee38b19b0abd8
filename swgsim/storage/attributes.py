"""Attributes of HDF5 files: numbers, and texts of fixed length.

HDF5 keeps a text of variable length in a heap, and a forged one makes it read for ever (docs/reliability.md).
"""

import h5py
import numpy as np

LONGEST_TEXT = 64_000  # bytes; HDF5 keeps an attribute in a header of 64 KiB


def set_attributes(owner: h5py.HLObject, **values: object) -> None:
    """Write attributes of a file, a group or a variable.

    Raises
    ------
    ValueError
        If a text is longer than :data:`LONGEST_TEXT`.
    """
    for name, value in values.items():
        owner.attrs[name] = _fixed(name, value) if isinstance(value, str) else value


def attribute(owner: h5py.HLObject, name: str) -> str | float:
    """Read one attribute.

    Raises
    ------
    KeyError
        If it does not exist.
    ValueError
        If it is not one number or one text of fixed length.
    """
    found = owner.attrs.get_id(name)
    text = h5py.check_string_dtype(found.dtype)
    sound = 0 < (text.length or 0) <= LONGEST_TEXT if text else found.dtype.kind in "fiu"
    if found.shape != () or not sound:
        raise ValueError(
            f"attribute {name} is {found.dtype} of shape {found.shape}, must be one number, or one text of a fixed "
            f"length of at most {LONGEST_TEXT} bytes"
        )
    value = owner.attrs[name]
    return str(value, "utf-8") if text else value.item()


def _fixed(name: str, text: str) -> np.ndarray:
    """A text as an array of fixed length."""
    raw = text.encode()
    if len(raw) > LONGEST_TEXT:
        raise ValueError(f"{name} has {len(raw)} bytes, an attribute holds at most {LONGEST_TEXT}: shorten it")
    return np.array(raw, h5py.string_dtype(length=max(len(raw), 1)))
