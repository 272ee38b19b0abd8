"""Numbers and arrays as C source."""

from collections.abc import Mapping

import numpy as np

LINE = 12  # values to a line

Macros = Mapping[str, int | float | str]  # macros of a method without their SWG_, with their values


def number(value: float | np.floating) -> str:
    """A number in single precision, with the digits that bring it back exactly.

    >>> number(0.1), number(2.0), number(float("nan"))
    ('0.1f', '2.0f', 'NAN')
    """
    if np.isnan(value):
        return "NAN"
    text = str(np.float32(value))
    return f"{text}f" if "." in text or "e" in text else f"{text}.0f"


def values(array: np.ndarray) -> str:
    """The elements of an array in braces, in C's order; floats in single precision.

    >>> values(np.array([[1, -2], [3, 4]]))
    '{1, -2, 3, 4}'
    """
    write = number if array.dtype.kind == "f" else str
    texts = [write(value) for value in array.ravel()]
    lines = (", ".join(texts[start : start + LINE]) for start in range(0, len(texts), LINE))
    return "{" + ",\n    ".join(lines) + "}"


def pairs(array: np.ndarray) -> str:
    """The rows of an array of two columns, each in braces.

    >>> pairs(np.array([[1, -2], [3, 4]]))
    '{{1, -2}, {3, 4}}'
    """
    return "{" + ", ".join(values(row) for row in array) + "}"


def array(name: str, content: np.ndarray, kind: str = "float", storage: str = "const") -> str:
    """The definition of an array of one dimension."""
    return f"{storage} {kind} {name}[{content.size}] = {values(content)};\n"


def macros(sizes: Macros) -> str:
    """A ``#define`` for each entry; floats in single precision, text as it is."""
    lines = (
        f"#define SWG_{name} {number(value) if isinstance(value, float) else value}" for name, value in sizes.items()
    )
    return "\n".join(lines) + "\n"
