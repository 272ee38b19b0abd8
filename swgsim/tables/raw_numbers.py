"""Files of bare numbers, as cards for data acquisition write them: one type, one after another, and nothing else."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.layout import Layout
from swgsim.tables.limits import require_rows


def read_raw(path: Path, name: str, wanted: Sequence[str | int], layout: Layout) -> dict[str | int, np.ndarray]:
    """The numbers of a file as its only column, 1.

    Parameters
    ----------
    path : Path
    name : str
        Name of the file in messages.
    wanted : sequence of str or int
    layout : Layout
        Its ``raw`` is the type of the numbers.

    Raises
    ------
    FileDefect
        If another column is wanted, or the file does not end after a whole number.
    """
    kind, size = np.dtype(layout.raw), path.stat().st_size
    for column in wanted:
        if column != 1:
            expected = "column 1, or the number of a signal beside 'interleaved' of the map"
            raise FileDefect(name, f"column {shown(column)} in a file of bare numbers", expected)
    if size % kind.itemsize:
        raise FileDefect(name, f"{size} bytes", f"whole numbers of {kind.itemsize} bytes, as {shown(layout.raw)} has")
    require_rows(name, size // kind.itemsize)
    return {1: np.fromfile(path, kind).astype(kind.newbyteorder("="))}
