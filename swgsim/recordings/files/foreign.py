"""The named columns of files from elsewhere: MATLAB, Parquet and CSV. Only numbers are read, never objects."""

from collections.abc import Sequence
from math import prod
from pathlib import Path

import h5py
import numpy as np
from jaxtyping import Float

from swgsim.recordings.files.csv_table import read_table
from swgsim.recordings.files.file_defect import FileDefect, shown
from swgsim.recordings.files.limits import require_expansion, require_readable, require_rows
from swgsim.recordings.files.mat_elements import NUMBERS
from swgsim.recordings.files.mat_variables import variables
from swgsim.recordings.files.recording_file import numbers

Columns = dict[str, Float[np.ndarray, " time"]]


def read_columns(path: Path, name: str, wanted: Sequence[str]) -> Columns:
    """Some columns of a file, each as long as it is in the file.

    Parameters
    ----------
    path : Path
        Its ending says what it is.
    name : str
        What messages call the file.
    wanted : sequence of str

    Raises
    ------
    FileDefect
        If the file is damaged or of an unknown kind, or a column is not there or holds no real numbers.
    """
    require_readable(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise FileDefect(name, shown(path.suffix), f"a file that ends in {', '.join(READERS)}")
    try:
        return reader(path, name, wanted)
    except (FileDefect, KeyboardInterrupt):
        raise
    except Exception as error:  # The libraries answer damaged bytes with errors of many kinds, also of their own.
        raise FileDefect(name, f"a damaged file ({type(error).__name__}: {error})", f"a sound {path.suffix}") from error


def _read_csv(path: Path, name: str, wanted: Sequence[str]) -> Columns:
    table = read_table(path, name)
    _require_present(name, wanted, table)
    return {column: table[column] for column in wanted}


def _read_matlab(path: Path, name: str, wanted: Sequence[str]) -> Columns:
    """A .mat file; version 7.3 is HDF5 behind a text of 512 bytes."""
    if h5py.is_hdf5(path):
        with h5py.File(path, "r") as file:
            _require_present(name, wanted, file)
            for column in wanted:
                link = file.get(column, getlink=True)
                if not isinstance(link, h5py.HardLink) or not isinstance(file[column], h5py.Dataset):
                    raise FileDefect(name, "a link or a struct", "a variable with numbers", column=column)
            require_expansion(path, name, sum(file[column].size or 0 for column in wanted))
            return {column: numbers(file[column], name, column) for column in wanted}
    from scipy.io import loadmat

    # Shapes first: what is compressed may be far larger than the file.
    there = variables(path, name)
    names = [variable.name for variable in there]
    _require_present(name, wanted, names)
    sizes = []
    for variable, shape, kind in there:
        if variable in wanted and names.count(variable) > 1:
            raise FileDefect(name, f"{names.count(variable)} variables of this name", "one", column=variable)
        if variable in wanted and kind not in NUMBERS.values():
            raise FileDefect(name, f"{shown(kind)} of shape {shown(shape)}", "real numbers", column=variable)
        if variable in wanted:
            sizes.append(prod(shape))
            require_rows(name, sizes[-1])
    require_expansion(path, name, sum(sizes))
    content = loadmat(path, variable_names=list(wanted))
    return {column: _real(content[column], name, column) for column in wanted}


def _read_parquet(path: Path, name: str, wanted: Sequence[str]) -> Columns:
    from pyarrow import parquet, types  # type: ignore[import-untyped]

    with parquet.ParquetFile(path) as file:
        _require_present(name, wanted, file.schema_arrow.names)
        for column in wanted:
            if file.schema_arrow.names.count(column) > 1:
                raise FileDefect(name, "several columns of this name", "one", column=column)
            kind = file.schema_arrow.field(column).type
            # A text or a list may be long and there once for all rows.
            if not (types.is_integer(kind) or types.is_floating(kind)):
                raise FileDefect(name, shown(str(kind)), "real numbers", column=column)
        groups = range(file.num_row_groups)
        rows = max(file.metadata.num_rows, sum(file.metadata.row_group(group).num_rows for group in groups))
        require_rows(name, rows)
        require_expansion(path, name, rows * len(wanted))
        table = file.read(columns=list(wanted))
    return {column: _real(table[column].to_numpy(), name, column) for column in wanted}


def _require_present(name: str, wanted: Sequence[str], there: object) -> None:
    """Raise unless all that the map names is there."""
    names = list(there)  # type: ignore[call-overload]
    for column in wanted:
        if column not in names:
            raise FileDefect(name, f"columns {', '.join(map(str, names[:20]))}", f"{shown(column)}, as the map says")


def _real(values: object, name: str, column: str) -> Float[np.ndarray, " time"]:
    """One row or column of real numbers."""
    sound = isinstance(values, np.ndarray) and values.dtype.kind in "fiu"
    if not isinstance(values, np.ndarray) or not sound or sum(length != 1 for length in values.shape) != 1:
        found = f"{getattr(values, 'dtype', type(values))} of shape {getattr(values, 'shape', ())}"
        raise FileDefect(name, found, "real numbers in one row or column", column=column)
    return values.astype("f8").ravel()


READERS = {".mat": _read_matlab, ".parquet": _read_parquet, ".csv": _read_csv}
