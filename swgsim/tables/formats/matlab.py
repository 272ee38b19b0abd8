"""The former name of :class:`~swgsim.tables.formats.limited.LimitedReader`."""

from swgsim.tables.formats.limited import LimitedReader as MatlabReader

__all__ = ["MatlabReader"]
