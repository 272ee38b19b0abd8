"""What a column is taken for, and why."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from swgsim.drafting.file_column import FileColumn
from swgsim.drafting.file_contents import FileContents


@dataclass(frozen=True, eq=False)
class DraftLine:
    """One line of a draft.

    Attributes
    ----------
    column : FileColumn
    quantity : str
        Channel, signal or ``time``; empty for a column that is not taken.
    entry : mapping
        What the map says of it.
    why : str
        The reason in a few words.
    question : str
        What the user must decide; empty if nothing.
    joint : str
        Name of the joint of a signal.
    active : bool
        Whether the map reads it; else its line is a comment until the user has decided.
    """

    column: FileColumn
    quantity: str
    entry: Mapping[str, Any] = field(default_factory=dict)
    why: str = ""
    question: str = ""
    joint: str = ""
    active: bool = True


def joined(*reasons: str) -> str:
    """Reasons that are not empty, as one text."""
    return "; ".join(reason for reason in reasons if reason)


def place(column: FileColumn) -> dict[str, Any]:
    """Where a map finds a column."""
    time = {"time": column.time} if column.time is not None else {}
    return {"column": column.column} | ({"file": column.file} if column.file else {}) | time


def travels(run: FileContents, drafted: Sequence[DraftLine]) -> list[float]:
    """How far each angle moves in a run, in the unit of its column."""
    angles = [(each.column.column, each.column.file) for each in drafted if each.quantity in ("q", "phi_in")]
    moved = [each.values for each in run.columns if (each.column, each.file) in angles]
    return [float(np.nanmax(values) - np.nanmin(values)) for values in moved]
