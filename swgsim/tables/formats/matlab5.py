"""MATLAB files of versions 4 to 7.2, by SciPy, in the child process: numbers in variables, structs and cell arrays.

What MATLAB calls an object, also a table or a string, has a form that SciPy does not know.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import chain
from pathlib import Path

import numpy as np
from scipy.io import loadmat, whosmat
from scipy.io.matlab import MatlabFunction, MatlabObject, MatlabOpaque

from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.contents import OBJECTS, Contents, Listed, few, meant

CLASSES = {"float64": "double", "float32": "single", "bool": "logical"}
KINDS: dict[type, str] = {MatlabOpaque: "opaque", MatlabObject: "object", MatlabFunction: "function"}
DEEPEST = 20

Entry = tuple[Listed, Callable[[], np.ndarray]]


@contextmanager
def opened(path: Path, file: str, wanted: Sequence[str | int] | None) -> Iterator[Contents]:
    """The variables of a file, and the members of the structs and cell arrays that may be meant."""
    try:
        variables = whosmat(path, appendmat=False)
        inside = [name for name, _, kind in variables if kind in ("struct", "cell") and meant(name, wanted)]
        content = loadmat(path, variable_names=inside, appendmat=False) if inside else {}
    except TypeError:  # SciPy lists no file with an object, which it calls None, but reads it
        content = {name: each for name, each in loadmat(path, appendmat=False).items() if not name.startswith("__")}
        variables = [(name, (), "object") for name in content]

    def entries(name: str, shape: tuple[int, ...], kind: str) -> Iterator[Entry]:
        if name in content:
            return _entries(name, content[name], file)
        return iter([(Listed(name, shape, kind), lambda: loadmat(path, variable_names=[name], appendmat=False)[name])])

    found = few(chain.from_iterable(entries(*variable) for variable in variables), file)
    yield Contents([listed for listed, _ in found], lambda place: _numbers(found[place][1]()))


def _entries(name: str, value: object, file: str, depth: int = 0) -> Iterator[Entry]:
    """A value and all within it; the elements of struct arrays and cell arrays count from 1, column by column."""
    kind = next((kind for each, kind in KINDS.items() if isinstance(value, each)), None)
    if kind == "opaque":
        name = _text(value, "s0") or name
        kind = _text(value, "s2") if _text(value, "s2") in OBJECTS else kind
    if kind or not isinstance(value, np.ndarray):
        yield Listed(name, getattr(value, "shape", ()), kind or type(value).__name__), lambda: np.array(None)
    elif depth == DEEPEST:
        raise FileDefect(file, f"structs in more than {DEEPEST} levels", "fewer", column=name)
    elif value.dtype.names:
        yield Listed(name, value.shape, "struct"), lambda: np.array(None)
        for field in value.dtype.names:
            yield from _field(name, field, value.ravel("F"), file, depth)
    elif value.dtype == object:
        yield Listed(name, value.shape, "cell"), lambda: np.array(None)
        for number, element in enumerate(value.ravel("F"), 1):
            yield from _entries(f"{name}[{number}]", element, file, depth + 1)
    else:
        kind = "char" if value.dtype.kind == "U" else CLASSES.get(value.dtype.name, value.dtype.name)
        yield Listed(name, value.shape, kind), lambda: value


def _field(name: str, field: str, elements: np.ndarray, file: str, depth: int) -> Iterator[Entry]:
    """A field of a struct, of every element of a struct array, or as one column where each has one number."""
    values = [element[field] for element in elements]
    if len(values) == 1:
        yield from _entries(f"{name}.{field}", values[0], file, depth + 1)
    elif values and all(map(_is_number, values)):
        yield from _entries(f"{name}.{field}", np.array([each.item() for each in values]), file, depth + 1)
    else:
        for number, each in enumerate(values, 1):
            yield from _entries(f"{name}[{number}].{field}", each, file, depth + 1)


def _text(value: object, field: str) -> str:
    """A text within an object: its name or its class."""
    found = value[field].ravel()[0] if isinstance(value, MatlabOpaque) and value.size else b""
    return found.decode("latin1") if isinstance(found, bytes) else ""


def _is_number(value: object) -> bool:
    return isinstance(value, np.ndarray) and value.size == 1 and value.dtype.kind in "fiub"


def _numbers(value: object) -> np.ndarray:
    """An array; a sparse one and what SciPy could not read become an object, which is no number."""
    array = value if isinstance(value, np.ndarray) else np.array(None)
    return array.astype("u1") if array.dtype == bool else array
