"""Readers: folders with a manifest, HDF5, MATLAB, Parquet and CSV with a column map; limits against hostile files."""
