"""Parquet files, by Arrow: columns of numbers, of lists of numbers, and of timestamps. Lost values become NaN."""

from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.contents import Contents, Listed


@contextmanager
def opened(path: Path, file: str, wanted: Sequence[str | int] | None) -> Iterator[Contents]:
    """The columns of a file in their order."""
    import pyarrow  # type: ignore[import-untyped]
    from pyarrow import compute, parquet, types

    def is_list(arrow: "pyarrow.DataType") -> bool:
        return types.is_list(arrow) or types.is_large_list(arrow) or types.is_fixed_size_list(arrow)

    def kind(arrow: "pyarrow.DataType") -> str:
        if types.is_boolean(arrow) or types.is_integer(arrow):
            return str(arrow)
        if types.is_floating(arrow):
            return f"float{arrow.bit_width}"
        # One long text or list may be stored once for all rows, and a decimal is no number of the computer.
        return "timestamp" if types.is_timestamp(arrow) or types.is_duration(arrow) else str(arrow)

    with parquet.ParquetFile(path) as source:
        groups = range(source.num_row_groups)
        rows = max(source.metadata.num_rows, sum(source.metadata.row_group(group).num_rows for group in groups))
        schema = source.schema_arrow
        counts = Counter[str]()
        for group in groups:
            for place in range(source.metadata.num_columns):
                chunk = source.metadata.row_group(group).column(place)
                counts[chunk.path_in_schema.partition(".")[0]] += chunk.num_values

        def entry(field: "pyarrow.Field") -> Listed:
            if not rows or not is_list(field.type) or counts[field.name] % rows:
                return Listed(field.name, (rows,), kind(field.type))
            return Listed(field.name, (rows, counts[field.name] // rows), kind(field.type.value_type))

        listed = [entry(field) for field in schema]

        def read(place: int) -> np.ndarray:
            name, _, shown, *_ = listed[place]
            if schema.names.count(name) > 1:  # Arrow reads by name
                raise FileDefect(file, "several columns of this name", "one", column=name)
            values = source.read(columns=[name])[name]
            if is_list(values.type):
                lengths = compute.list_value_length(values)
                width = listed[place].shape[-1]
                if lengths.null_count or not compute.all(compute.equal(lengths, width)).as_py():
                    raise FileDefect(file, "lists of different lengths", "as many numbers in each row", column=name)
                return compute.list_flatten(values).to_numpy().reshape(-1, width)
            if shown == "timestamp":
                if values.null_count:
                    raise FileDefect(file, f"{values.null_count} rows without a time", "a time in each", column=name)
                time = pyarrow.timestamp if types.is_timestamp(values.type) else pyarrow.duration
                zone = {"tz": values.type.tz} if types.is_timestamp(values.type) else {}
                values = compute.cast(values, time("ns", **zone)).cast(pyarrow.int64())
            elif types.is_boolean(values.type):
                values = values.cast(pyarrow.uint8())
            return values.to_numpy()

        yield Contents(listed, read, ordered=True)
