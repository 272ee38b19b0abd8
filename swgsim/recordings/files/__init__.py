"""Readers of folders with a manifest, HDF5, MATLAB, Parquet and CSV files, with limits against hostile ones."""
