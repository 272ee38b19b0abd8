"""Columns of numbers from the files that people have: text of any layout, MATLAB, HDF5, Parquet and others.

A :class:`Layout` says how a file is written, and a :class:`MeasuredColumn` what its numbers mean; a :class:`TableMap`
has both. Nothing is guessed.
"""

from swgsim.tables.file_defect import FileDefect
from swgsim.tables.layout import Layout
from swgsim.tables.measured_column import MeasuredColumn
from swgsim.tables.table_map import TableMap

__all__ = ["FileDefect", "Layout", "MeasuredColumn", "TableMap"]
