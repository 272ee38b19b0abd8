"""HDF5 files, also those of MATLAB 7.3: groups are structs, and references lead to the elements of cell arrays.

Nothing outside of the file is read: links, virtual data sets and raw data of other files are refused.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import h5py
import numpy as np

from swgsim.storage import hdf5_reader
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.contents import MOST_NAMES, OBJECTS, Contents, Listed, few, meant

DEEPEST = 20
LONGEST_TEXT = 200  # bytes of a unit or a class

Entry = tuple[Listed, Callable[[], np.ndarray]]


@contextmanager
def opened(path: Path, file: str, wanted: Sequence[str | int] | None) -> Iterator[Contents]:
    """The variables of a file in the order of their names, and the members of its groups."""
    with hdf5_reader.opened(path) as source:
        matlab = any(_attribute(source[name], "MATLAB_class") for name in source if _inside(source, name))
        walk = _Walk(source, file, "." if matlab else "/", wanted)
        found = few(walk.members(source, "", 0), file)
        yield Contents([listed for listed, _ in found], lambda place: found[place][1]())


def values(variable: h5py.Dataset, file: str, column: str) -> np.ndarray:
    """Numbers of a variable, in MATLAB's order of rows and columns if it wrote them.

    Raises
    ------
    FileDefect
        If its data are in another file, or it holds no real numbers.
    """
    if variable.is_virtual or variable.external:
        raise FileDefect(file, "data in another file", "data in the file itself", column=column)
    if variable.dtype.kind not in "fiub":
        found = f"{variable.dtype} of shape {variable.shape}"
        raise FileDefect(file, found, "real numbers in one row or column", column=column)
    found = variable[()]
    found = found.astype("u1") if found.dtype == bool else found
    return found.T if _attribute(variable, "MATLAB_class") else found


@dataclass(frozen=True)
class _Walk:
    """A way through all groups and references of a file."""

    source: h5py.File
    file: str
    separator: str
    wanted: Sequence[str | int] | None

    def members(self, group: h5py.Group, name: str, depth: int) -> Iterator[Entry]:
        """The members of a group, or of the elements of a struct array."""
        if depth == DEEPEST:
            raise FileDefect(self.file, f"groups in more than {DEEPEST} levels", "fewer", column=name)
        for key in group:
            if key.startswith("#"):  # where MATLAB keeps the elements of cells, and its objects
                continue
            member = f"{name}{self.separator}{key}" if name else key
            if not _inside(group, key):
                yield Listed(member, (), "link"), _nothing
            elif name and _is_field_of_array(group[key]):
                yield from self.field(group[key], name, key, depth)
            else:
                yield from self.entries(group[key], member, depth)

    def entries(self, item: h5py.HLObject, name: str, depth: int) -> Iterator[Entry]:
        """An object of the file, and all within it."""
        kind = _attribute(item, "MATLAB_class")
        if _attribute(item, "MATLAB_object_decode"):
            yield Listed(name, getattr(item, "shape", ()), kind if kind in OBJECTS else "object"), _nothing
        elif isinstance(item, h5py.Group):
            sparse = "MATLAB_sparse" in item.attrs
            yield Listed(name, (), "sparse" if sparse else kind or "group"), _nothing
            if not sparse:
                yield from self.members(item, name, depth + 1)
        elif not isinstance(item, h5py.Dataset) or item.shape is None:
            yield Listed(name, (), "nothing"), _nothing
        elif item.dtype.names:
            yield Listed(name, item.shape, "struct"), _nothing
            for field in item.dtype.names:
                yield self.compound(item, name, field)
        elif kind == "cell" and _is_references(item):
            yield Listed(name, item.shape[::-1], "cell"), _nothing
            if self.meant(name):
                for number, element in enumerate(self.elements(item, name), 1):
                    yield from self.entries(element, f"{name}[{number}]", depth + 1)
        else:
            shape = item.shape[::-1] if kind else item.shape
            shape = (0,) if "MATLAB_empty" in item.attrs else shape
            whole = self.wanted is None  # in a process with a limit of time
            unit = _attribute(item, "units", whole) or _attribute(item, "unit", whole)
            yield Listed(name, shape, kind or _kind(item.dtype), unit), partial(values, item, self.file, name)

    def meant(self, name: str) -> bool:
        """Whether the variable to which something belongs is looked for; others may have very many elements."""
        return meant(re.split(r"[.\[/]", name)[0], self.wanted)

    def field(self, item: h5py.Dataset, name: str, key: str, depth: int) -> Iterator[Entry]:
        """A field of a struct array: one column where each element has one number."""
        if not self.meant(name):
            return
        elements = self.elements(item, name)
        if all(isinstance(each, h5py.Dataset) and each.size == 1 and each.dtype.kind in "fiu" for each in elements):
            kind = np.result_type(*(each.dtype for each in elements)).name if elements else "nothing"
            listed = Listed(f"{name}{self.separator}{key}", (len(elements),), kind)
            yield listed, lambda: np.array([values(each, self.file, listed.name).item() for each in elements])
            return
        for number, element in enumerate(elements, 1):
            yield from self.entries(element, f"{name}[{number}]{self.separator}{key}", depth + 1)

    def compound(self, item: h5py.Dataset, name: str, field: str) -> Entry:
        """A field of a table of records."""
        kind = item.dtype[field]
        listed = Listed(f"{name}.{field}", item.shape + kind.shape, _kind(kind.base))

        def read() -> np.ndarray:
            if item.is_virtual or item.external:
                raise FileDefect(self.file, "data in another file", "data in the file itself", column=listed.name)
            return item.fields(field)[()]

        return listed, read

    def elements(self, item: h5py.Dataset, name: str) -> list[h5py.HLObject]:
        """What the references of a cell array or a field lead to, within the file."""
        if item.is_virtual or item.external or item.size > MOST_NAMES:
            raise FileDefect(self.file, f"{item.size} references", f"at most {MOST_NAMES} in the file", column=name)
        references = item[()].ravel()  # as stored: MATLAB counts column by column, and HDF5 has its order reversed
        if not all(references):
            raise FileDefect(self.file, "references to nothing", "a sound file", column=name)
        return [self.source[reference] for reference in references]


def _inside(group: h5py.Group, name: str) -> bool:
    """Whether a member is stored in the group itself; links may lead out of the file."""
    return isinstance(group.get(name, getlink=True), h5py.HardLink)


def _is_references(item: h5py.HLObject) -> bool:
    return isinstance(item, h5py.Dataset) and h5py.check_ref_dtype(item.dtype) is h5py.Reference


def _is_field_of_array(item: h5py.HLObject) -> bool:
    """Whether an object is a field of a struct array, which has references but no class."""
    return _is_references(item) and not _attribute(item, "MATLAB_class")


def _kind(dtype: np.dtype) -> str:
    return "references" if h5py.check_ref_dtype(dtype) else "text" if dtype.kind in "SUO" else dtype.name


def _attribute(owner: h5py.HLObject, name: str, limited: bool = False) -> str:
    """A short text or a number; HDF5 reads forged texts without a fixed length for ever, unless its time is limited."""
    if name not in owner.attrs:
        return ""
    found = owner.attrs.get_id(name)
    text = h5py.check_string_dtype(found.dtype)
    fixed = text is not None and 0 < (text.length or 0) <= LONGEST_TEXT
    if found.shape != () or not (fixed or (limited if text else found.dtype.kind in "fiu")):
        return ""
    value = owner.attrs[name]
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)[:LONGEST_TEXT]


def _nothing() -> np.ndarray:
    return np.array(None)
