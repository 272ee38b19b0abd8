"""The report of the transfer study as one HTML page and as JSON."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from learn.transfer_report.sentences import Goal
from swgsim.common.html import environment
from swgsim.common.style import Picture


@dataclass(frozen=True)
class Table:
    """A table of text; the first `left` columns are aligned to the left, rows whose number is in `strong` are bold."""

    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    note: str = ""
    left: int = 1
    strong: frozenset[int] = frozenset()


@dataclass(frozen=True)
class Listed:
    """Sentences as a list."""

    items: Sequence[str]


@dataclass(frozen=True)
class Section:
    """A part of the page: paragraphs (text), lists, tables and pictures in their order."""

    key: str
    title: str
    parts: Sequence[str | Listed | Table | Picture]


@dataclass(frozen=True)
class TransferReport:
    """All that the report of the transfer study says.

    Attributes
    ----------
    grid : str
        Name of the grid of the judged gears.
    content : mapping
        ``transfer.json``.
    goals : sequence of Goal
    plain : sequence of str
        How the best methods were chosen, and where a fancy method does not beat the simple one.
    levels : sequence of (str, str)
        Levels of target information with what each means.
    sections : sequence of Section
    """

    grid: str
    content: Mapping[str, Any]
    goals: Sequence[Goal]
    plain: Sequence[str]
    levels: Sequence[tuple[str, str]]
    sections: Sequence[Section]

    def json(self) -> str:
        """``transfer.json``."""
        return json.dumps(dict(self.content), indent=2, allow_nan=False) + "\n"

    def html(self) -> str:
        """``transfer.html``: one file, pictures inside."""
        templates = environment("learn")
        templates.filters["kind"] = lambda part: type(part).__name__
        return templates.get_template("transfer_report/transfer_page.html.jinja").render(report=self)
