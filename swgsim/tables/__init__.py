"""Columns of numbers from the files that people have: text of any layout, MATLAB, HDF5, Parquet and others.

A :class:`~swgsim.tables.layout.Layout` says how a file is written, and a
:class:`~swgsim.tables.measured_column.MeasuredColumn` what its numbers mean. Nothing is guessed. Imports ``common``.
"""
