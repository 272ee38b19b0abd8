"""What an HDF5 file says of itself: texts and numbers of a length that is known before they are read.

A text of variable length lies in a heap, and a forged one makes HDF5 read without end (docs/reliability.md).
"""

import h5py
import numpy as np

LONGEST = 64_000  # bytes; HDF5 keeps an attribute in a header of 64 KiB


def say(owner: h5py.HLObject, **said: object) -> None:
    """Keep attributes of a file, a group or a variable.

    Raises
    ------
    ValueError
        If a text is longer than :data:`LONGEST`.
    """
    for name, value in said.items():
        owner.attrs[name] = _fixed(name, value) if isinstance(value, str) else value


def attribute(owner: h5py.HLObject, name: str) -> str | float:
    """One attribute.

    Raises
    ------
    KeyError
        If it is not there.
    ValueError
        If it is neither one number nor one text of fixed length.
    """
    found = owner.attrs.get_id(name)
    text = h5py.check_string_dtype(found.dtype)
    sound = 0 < (text.length or 0) <= LONGEST if text else found.dtype.kind in "fiu"
    if found.shape != () or not sound:
        raise ValueError(
            f"attribute {name} is {found.dtype} of shape {found.shape}, must be one number, or one text of a fixed "
            f"length of at most {LONGEST} bytes"
        )
    value = owner.attrs[name]
    return str(value, "utf-8") if text else value.item()


def _fixed(name: str, text: str) -> np.ndarray:
    """A text as HDF5 keeps it with its length."""
    raw = text.encode()
    if len(raw) > LONGEST:
        raise ValueError(f"{name} has {len(raw)} bytes, a file says at most {LONGEST} of itself: choose less")
    return np.array(raw, h5py.string_dtype(length=max(len(raw), 1)))
