"""Named columns of MATLAB, HDF5, Parquet and CSV files. Only numbers are read, never objects."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from swgsim.recordings.files.csv_table import read_table
from swgsim.tables import binary
from swgsim.tables.column_names import column_place
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.limits import require_readable

READERS = (*binary.HERE, *binary.IN_CHILD, ".csv")


def read_columns(
    path: Path, name: str, wanted: Sequence[str], matlab: LimitedReader | None = None
) -> dict[str, Float[np.ndarray, " time"]]:
    """Some columns of a file, each with as many samples as in the file.

    Raises
    ------
    FileDefect
        If the file is damaged or of an unknown format, or a column is missing or holds no real numbers.
    """
    require_readable(path)
    if binary.is_binary(path):
        return {
            str(each): values.astype("f8") for each, values in binary.read_columns(path, name, wanted, matlab).items()
        }
    if path.suffix.lower() != ".csv":
        raise FileDefect(name, shown(path.suffix), f"a file that ends in {', '.join(READERS)}")
    table = read_table(path, name)
    names = list(table)
    return {each: table[names[column_place(each, names, name, 1)]] for each in wanted}
