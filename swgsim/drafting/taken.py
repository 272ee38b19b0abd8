"""What a column is taken for, and why."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from swgsim.drafting.seen_column import SeenColumn


@dataclass(frozen=True, eq=False)
class Taken:
    """One line of a draft.

    Attributes
    ----------
    column : SeenColumn
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

    column: SeenColumn
    quantity: str
    entry: Mapping[str, Any] = field(default_factory=dict)
    why: str = ""
    question: str = ""
    joint: str = ""
    active: bool = True


def joined(*reasons: str) -> str:
    """Reasons that are not empty, as one text."""
    return "; ".join(reason for reason in reasons if reason)


def place(column: SeenColumn) -> dict[str, Any]:
    """Where a map finds a column."""
    time = {"time": column.time} if column.time is not None else {}
    return {"column": column.column} | ({"file": column.file} if column.file else {}) | time
