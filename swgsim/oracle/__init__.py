"""Classifier by Bayes' rule that knows gear, faults and statistics of the bench; it has the lowest attainable error."""

from swgsim.oracle.cells import Resolution
from swgsim.oracle.columns import KNOWN

__all__ = [
    "KNOWN",
    "Resolution",
]
