"""JSON lines: one object for each sample. Members are ``a.b``, elements of lists ``a[3]``; ISO 8601 is a timestamp."""

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pandas as pd

from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.contents import Contents, Listed
from swgsim.tables.limits import ALWAYS_EXPANDED

KINDS = {"M": "timestamp", "O": "text"}


@contextmanager
def opened(path: Path, file: str, wanted: Sequence[str | int] | None) -> Iterator[Contents]:
    """The members of the objects of a file, in the order in which they appear."""
    if path.stat().st_size > ALWAYS_EXPANDED:  # objects take many times the memory of numbers
        found = f"{path.stat().st_size} bytes of JSON"
        raise FileDefect(file, found, f"at most {ALWAYS_EXPANDED}: split the recording, or write it as Parquet")
    with path.open(encoding="utf-8-sig") as lines:
        samples = [_sample(line, file, row) for row, line in enumerate(lines, 1) if line.strip()]
    table = pd.json_normalize(samples)
    arrays = {str(name): _array(values) for name, values in table.items()}
    listed = [
        Listed(name, values.shape, KINDS.get(values.dtype.kind, str(values.dtype))) for name, values in arrays.items()
    ]

    def read(place: int) -> np.ndarray:
        values = arrays[listed[place].name]
        return values.astype(np.int64) if values.dtype.kind == "M" else values

    yield Contents(listed, read, ordered=True)


def _sample(line: str, file: str, row: int) -> dict:
    """The object of one line."""
    try:
        sample = json.loads(line)
    except json.JSONDecodeError as error:
        raise FileDefect(file, f"no JSON ({error.msg})", "one JSON object in each line", row) from None
    if not isinstance(sample, dict):
        raise FileDefect(file, f"a {type(sample).__name__}", "one JSON object in each line", row)
    return sample


def _array(values: pd.Series) -> np.ndarray:
    """Numbers, lists of as many numbers, or nanoseconds of time stamps; objects where they are something else."""
    if values.dtype.kind in "iuf":
        return values.to_numpy()
    if values.dtype.kind == "b":
        return values.to_numpy(dtype=np.uint8)
    if values.map(lambda cell: isinstance(cell, list)).all():
        try:
            return np.array(values.tolist(), dtype=float)
        except (TypeError, ValueError):
            return values.to_numpy()
    if values.map(lambda cell: isinstance(cell, str)).all():
        stamps = pd.to_datetime(values, format="ISO8601", errors="coerce", utc=True)
        return values.to_numpy() if stamps.isna().any() else stamps.to_numpy(dtype="datetime64[ns]")
    return pd.to_numeric(values, errors="coerce").to_numpy() if values.isna().any() else values.to_numpy()
