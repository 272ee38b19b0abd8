"""Labelled gauge signals in memory and on disk: arrays with a table, sealed HDF5 files, order lines."""

from swgsim.storage.attributes import attribute
from swgsim.storage.hdf5_writer import created
from swgsim.storage.labelled_signals import CLASSES, COLUMNS, SENSORS, LabelledSignals, facts
from swgsim.storage.orders import lines_of, order_lines, revolution, whole_revolutions

__all__ = [
    "CLASSES",
    "COLUMNS",
    "SENSORS",
    "LabelledSignals",
    "attribute",
    "created",
    "facts",
    "lines_of",
    "order_lines",
    "revolution",
    "whole_revolutions",
]
