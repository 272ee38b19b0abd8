"""Named columns of MATLAB, Parquet and CSV files. Only numbers are read, never objects."""

from collections.abc import Iterable, Sequence
from contextlib import nullcontext
from math import prod
from pathlib import Path

import h5py
import numpy as np
from jaxtyping import Float

from swgsim.recordings.files.assembly import ONE_TABLE
from swgsim.recordings.files.csv_table import read_table
from swgsim.recordings.files.file_defect import FileDefect, shown
from swgsim.recordings.files.limits import require_expansion, require_readable, require_rows
from swgsim.recordings.files.matlab import MatlabReader
from swgsim.recordings.files.recording_file import numbers
from swgsim.storage.hdf5_reader import opened

Columns = dict[str, Float[np.ndarray, " time"]]
# Classes of MATLAB that are numbers; all others are refused by their name.
MATLAB_NUMBERS = ("double", "single", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)))


def read_columns(path: Path, name: str, wanted: Sequence[str], matlab: MatlabReader | None = None) -> Columns:
    """Some columns of a file, each with as many samples as in the file.

    Parameters
    ----------
    path : Path
        Its suffix gives the format.
    name : str
        Name of the file in messages.
    wanted : sequence of str
    matlab : MatlabReader, optional
        Reader that the files of a folder share; without it, each old MATLAB file starts one (0.3 s).

    Raises
    ------
    FileDefect
        If the file is damaged or of an unknown format, or a column is missing or holds no real numbers.
    """
    require_readable(path)
    suffix = path.suffix.lower()
    if suffix not in READERS:
        raise FileDefect(name, shown(path.suffix), f"a file that ends in {', '.join(READERS)}")
    try:
        if suffix == ".mat" and not h5py.is_hdf5(path):
            with nullcontext(matlab) if matlab else MatlabReader() as reader:
                return _read_matlab(path, name, wanted, reader)
        return READERS[suffix](path, name, wanted)
    except FileDefect:
        raise
    except Exception as error:  # The libraries raise errors of many kinds for damaged bytes, also their own.
        raise FileDefect(name, f"a damaged file ({type(error).__name__}: {error})", f"a sound {suffix}") from error


def _read_csv(path: Path, name: str, wanted: Sequence[str]) -> Columns:
    table = read_table(path, name)
    _require_present(name, wanted, table)
    return {column: table[column] for column in wanted}


def _read_matlab_73(path: Path, name: str, wanted: Sequence[str]) -> Columns:
    """A MATLAB file of version 7.3, which is HDF5 behind a text of 512 bytes."""
    with opened(path) as file:
        _require_present(name, wanted, file)
        for column in wanted:
            link = file.get(column, getlink=True)
            if not isinstance(link, h5py.HardLink) or not isinstance(file[column], h5py.Dataset):
                raise FileDefect(name, "a link or a struct", "a variable with numbers", column=column)
        require_expansion(path, name, sum(file[column].size or 0 for column in wanted))
        return {column: numbers(file[column], name, column) for column in wanted}


def _read_matlab(path: Path, name: str, wanted: Sequence[str], reader: MatlabReader) -> Columns:
    """A MATLAB file of version 4 or 5. Shapes are checked first, as compressed numbers may exceed the file by far."""
    variables = reader.variables(path, name)
    names = [variable.name for variable in variables]
    _require_present(name, wanted, names)
    chosen = [variable for variable in variables if variable.name in wanted]
    for column, shape, kind in chosen:
        if names.count(column) > 1:
            raise FileDefect(name, f"{names.count(column)} variables of this name", "one", column=column)
        if kind not in MATLAB_NUMBERS:
            raise FileDefect(name, f"{shown(kind)} of shape {shown(shape)}", "real numbers", column=column)
        require_rows(name, prod(shape))
    require_expansion(path, name, sum(prod(variable.shape) for variable in chosen))
    return {column: _real(values, name, column) for column, values in reader.numbers(path, name, wanted).items()}


def _read_parquet(path: Path, name: str, wanted: Sequence[str]) -> Columns:
    from pyarrow import parquet, types  # type: ignore[import-untyped]

    with parquet.ParquetFile(path) as file:
        _require_present(name, wanted, file.schema_arrow.names)
        for column in wanted:
            if file.schema_arrow.names.count(column) > 1:
                raise FileDefect(name, "several columns of this name", "one", column=column)
            kind = file.schema_arrow.field(column).type
            # One long text or list may be stored once for all rows.
            if not (types.is_integer(kind) or types.is_floating(kind)):
                raise FileDefect(name, shown(str(kind)), "real numbers", column=column)
        groups = range(file.num_row_groups)
        rows = max(file.metadata.num_rows, sum(file.metadata.row_group(group).num_rows for group in groups))
        require_rows(name, rows)
        require_expansion(path, name, rows * len(wanted))
        table = file.read(columns=list(wanted))
    return {column: _real(table[column].to_numpy(), name, column) for column in wanted}


def _require_present(name: str, wanted: Sequence[str], present: Iterable[str]) -> None:
    """Raise a FileDefect unless a file has all columns of the map."""
    names = list(present)
    for column in wanted:
        if column not in names:
            found, expected = f"columns {', '.join(names[:20])}", f"{shown(column)}, as in the column map (mapping=)"
            raise FileDefect(name, found, expected + (f"; {ONE_TABLE}" if len(names) <= 2 else ""))


def _real(values: object, name: str, column: str) -> Float[np.ndarray, " time"]:
    """One row or column of real numbers."""
    sound = isinstance(values, np.ndarray) and values.dtype.kind in "fiu"
    if not isinstance(values, np.ndarray) or not sound or sum(length != 1 for length in values.shape) != 1:
        found = f"{getattr(values, 'dtype', type(values))} of shape {getattr(values, 'shape', ())}"
        raise FileDefect(name, found, "real numbers in one row or column", column=column)
    return values.astype("f8").ravel()


READERS = {".mat": _read_matlab_73, ".parquet": _read_parquet, ".csv": _read_csv}
