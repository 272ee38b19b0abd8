"""Bayes' classifier that knows gear, faults and the statistics of the bench: the least error that is possible.

Imports ``dataset``, ``jobs`` and rooms below these.
"""

from swgsim.oracle.cells import Resolution
from swgsim.oracle.columns import KNOWN

__all__ = [
    "KNOWN",
    "Resolution",
]
