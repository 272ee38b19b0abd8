"""Columns of numbers of binary files and of JSON, whose ending says the format."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from math import prod
from pathlib import Path

import h5py
import numpy as np

from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.formats import hdf5, json_lines, parquet
from swgsim.tables.formats.contents import Contents, Listed
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.limits import require_expansion, require_readable, require_rows
from swgsim.tables.references import Reference, column, referred

# Ending to the module of its reader. Those of the first line are safe in this process.
HERE = {".h5": hdf5, ".hdf5": hdf5, ".parquet": parquet, ".jsonl": json_lines, ".ndjson": json_lines}
IN_CHILD = {
    ".mat": "matlab5", ".tdms": "tdms", ".mf4": "mdf", ".mf3": "mdf", ".mdf": "mdf",
    ".uff": "uff", ".unv": "uff", ".uf58": "uff",
}  # fmt: skip
# Beginnings of an MDF file, whose older versions share the ending .dat with text.
MDF_BEGINS = (b"MDF     ", b"UnFinMF ")

# The time of the other columns, where the format knows it.
TIME = "time"


def is_binary(path: Path) -> bool:
    """Whether :func:`read_columns` reads a file; others are text.

    >>> is_binary(Path("run1.MAT")), is_binary(Path("run1.dat"))
    (True, False)
    """
    return path.suffix.lower() in {*HERE, *IN_CHILD} or _is_mdf(path)


def read_columns(
    path: Path, name: str, wanted: Sequence[str | int], reader: LimitedReader | None = None
) -> dict[str | int, np.ndarray]:
    """Some columns of a file, in the numeric type of the file: integers keep all digits.

    Parameters
    ----------
    path : Path
        Its ending gives the format.
    name : str
        Name of the file in messages.
    wanted : sequence of str or int
        References as :func:`~swgsim.tables.references.referred` takes them, and ``time`` [s] for the time base of the
        other columns where the format keeps one (TDMS, MDF, UFF).
    reader : LimitedReader, optional
        Child process that the files of a folder share; without it, each file of MATLAB starts one (0.3 s).

    Returns
    -------
    dict
        Reference to array (time,), each with as many samples as in the file.

    Raises
    ------
    FileDefect
        If the file is damaged, or a reference means no column of real numbers, or several.
    """
    wanted = list(dict.fromkeys(wanted))
    with _opened(path, name, wanted, reader) as contents:
        pseudo = [each for each in wanted if _is_pseudo(each, contents)]
        found = {each: referred(each, contents, name) for each in wanted if each not in pseudo}
        based = _based(found, bool(pseudo), contents, name)
        for place, _ in found.values():
            require_rows(name, max(contents.listed[place].shape, default=1))
        places = dict.fromkeys([place for place, _ in found.values()])
        require_expansion(path, name, sum(prod(contents.listed[place].shape) for place in places))
        arrays = {place: _real(contents.read(place), contents.listed[place], name) for place in places}
        columns = {each: column(arrays[place], line) for each, (place, line) in found.items()}
        for each in pseudo:
            assert contents.time
            columns[each] = contents.time(based)
        return {each: columns[each] for each in wanted}


def listed(path: Path, name: str, reader: LimitedReader | None = None) -> list[Listed]:
    """What a file holds, for messages and for drafts of maps.

    Raises
    ------
    FileDefect
        If the file is damaged.
    """
    with _opened(path, name, None, reader) as contents:
        return list(contents.listed)


def names(path: Path, name: str, reader: LimitedReader | None = None) -> list[str]:
    """All names by which entries of a file are found, such as ``group/channel``; errors as for :func:`listed`."""
    with _opened(path, name, None, reader) as contents:
        return [*(each.name for each in contents.listed), *contents.others]


@contextmanager
def _opened(
    path: Path, name: str, wanted: Sequence[str | int] | None, reader: LimitedReader | None
) -> Iterator[Contents]:
    """The contents of a file; errors of its library become a FileDefect."""
    require_readable(path)
    suffix = path.suffix.lower()
    try:
        here = hdf5 if suffix == ".mat" and h5py.is_hdf5(path) else HERE.get(suffix)  # MATLAB 7.3
        if here and not (here is hdf5 and wanted is None):
            with here.opened(path, name, wanted) as contents:
                yield contents
        elif here or suffix in IN_CHILD or _is_mdf(path):
            with nullcontext(reader) if reader else LimitedReader() as child:
                yield child.contents(path, name, "hdf5" if here else IN_CHILD.get(suffix, "mdf"), wanted)
        else:
            raise FileDefect(name, shown(path.suffix), f"a file that ends in {', '.join([*HERE, *IN_CHILD])}")
    except FileDefect:
        raise
    except Exception as error:  # The libraries raise errors of many kinds for damaged bytes, also their own.
        raise FileDefect(name, f"a damaged file ({type(error).__name__}: {error})", f"a sound {suffix}") from error


def _is_mdf(path: Path) -> bool:
    """Whether a file that ends in .dat is MDF."""
    if path.suffix.lower() != ".dat" or not path.is_file():
        return False
    with path.open("rb") as raw:
        return raw.read(8) in MDF_BEGINS


def _is_pseudo(wanted: str | int, contents: Contents) -> bool:
    """Whether a reference means the time base."""
    names = {each.name for each in contents.listed}
    return wanted == TIME and contents.time is not None and TIME not in names and TIME not in contents.others


def _based(found: Mapping[str | int, Reference], asked: bool, contents: Contents, file: str) -> int:
    """Place of an entry with the time base of all, which is asked for or where the format keeps one.

    Raises
    ------
    FileDefect
        If there are several bases, or none although it is asked for.
    """
    places = {place for place, _ in found.values()} or set(range(len(contents.listed)))
    bases = {contents.listed[place].base: place for place in sorted(places)}
    known = {base: place for base, place in bases.items() if base}
    if len(known) > 1 and (asked or found):
        texts = "; ".join(f"{shown(contents.listed[place].name)}: {base}" for base, place in list(known.items())[:5])
        raise FileDefect(file, f"different time bases ({texts})", "one: export these channels resampled to one")
    if asked and (not known or "" in bases):
        without = contents.listed[bases[""]].name if "" in bases else "any channel"
        raise FileDefect(
            file, f"no time base of {without}", "one: map a column with the time, or give the sampling rate"
        )
    return next(iter(known.values()), 0)


def _real(values: np.ndarray, entry: Listed, file: str) -> np.ndarray:
    """Values as they were listed."""
    if values.dtype.kind not in "fiu" or prod(values.shape) != prod(entry.shape):
        raise FileDefect(file, f"{values.dtype} of shape {values.shape}", "real numbers", column=entry.name)
    return values
