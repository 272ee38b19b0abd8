"""Columns of numbers from the files that people have: text of any layout, MATLAB, HDF5, Parquet and others.

A :class:`Layout` says how a file is written, and a :class:`MeasuredColumn` what its numbers mean; a :class:`TableMap`
has both. Nothing is guessed.
"""

import lazy_loader

# A name is imported when it is used: the child process that reads a file needs no pandas.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
