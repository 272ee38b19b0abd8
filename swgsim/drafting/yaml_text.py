"""A draft as YAML with comments: what was understood and why, and what the user must decide."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import yaml

from swgsim.drafting.clock import ClockDraft
from swgsim.drafting.draft_line import DraftLine
from swgsim.drafting.file_contents import FileContents
from swgsim.tables.layout import Layout

ASK = "# ???"
NOT_UNDERSTOOD = "???"
SEPARATORS = {"\t": "tab", " ": "blanks"}
# Longest comment, so that a line is read at a glance.
LONGEST_COMMENT = 110


def flow(value: Any) -> str:
    """A value in one line of YAML.

    >>> flow({"column": "Zeit [s]", "unit": "s"})
    "{column: 'Zeit [s]', unit: s}"
    """
    text = yaml.safe_dump(value, default_flow_style=True, allow_unicode=True, width=10**6, sort_keys=False)
    return text.strip().removesuffix("...").strip()


def line(key: str, value: Any, why: str = "", question: str = "", indent: int = 0, active: bool = True) -> str:
    """One entry, with the reason or the question behind it; an entry that is not active is a comment."""
    remark = f"  {ASK} {short(question)}" if question else f"  # {short(why)}" if why else ""
    begin = "" if active else f"{ASK} "
    return " " * indent + begin + f"{key}: {flow(value)}" + remark


def short(text: str) -> str:
    """A comment of one line."""
    one = " ".join(text.split())
    return one if len(one) <= LONGEST_COMMENT else one[: LONGEST_COMMENT - 1] + "…"


def layout_lines(contents: FileContents, drafted: Sequence[DraftLine]) -> Iterable[str]:
    """Entries of the layout that are not the usual ones."""
    layout, usual = contents.layout, Layout()
    if layout is not None:
        if layout.separator != usual.separator:
            yield line("separator", SEPARATORS.get(layout.separator, layout.separator))
        for key in ("decimal", "encoding", "comment"):
            if getattr(layout, key) != getattr(usual, key):
                yield line(key, getattr(layout, key))
        if layout.sheet or layout.rows:
            yield line("each", ".+", "several recordings in one file; {NAME: {repeat: 2}, ...} has facts of each")
        if layout.sheet:
            yield line("sheet", layout.sheet, "the row of names comes again: so many tables below one another")
        if layout.rows:
            yield line("rows", dict(layout.rows), "it changes where the time begins again")
        if layout.header_row == 0:
            yield line("header", False)
        elif layout.header_row is not None:
            yield line("header_row", layout.header_row)
        if layout.first_row is not None:
            yield line("first_row", layout.first_row)
    read = [each.column for each in drafted if each.quantity and each.active]
    if lost := max((each.lost for each in read), default=0):
        share = lost / len(read[0].values)
        value = "leave_out" if share < 0.01 else {"leave_out": lost}
        yield line("lost", value, "", f"up to {lost} readings are lost in a column: leave out their rows?")
    if contents.interleaved > 1:
        yield line("interleaved", contents.interleaved, "so many signals follow one another in each column")


def left_lines(drafted: Sequence[DraftLine], contents: FileContents, others: Mapping[str, str]) -> Iterable[str]:
    """Comments on what is not read."""
    left = [each for each in drafted if not each.quantity]
    if left:
        yield ""
        yield "# Columns that are not read, with their first values:"
    for each in left:
        file = f" of {each.column.file}" if each.column.file else ""
        yield f"#   {short(f'{each.column.column}{file}: {each.column.first}  ({each.why or NOT_UNDERSTOOD})')}"
    if contents.others:
        yield ""
        yield "# What else is in the file: " + short(
            "; ".join(f"{name} ({what})" for name, what in contents.others.items())
        )
    for name, why in list(others.items())[:10]:
        yield f"# Not read: {short(f'{name}: {why}')}"


def clock_lines(key: str, clock: ClockDraft | None, indent: int = 0) -> Iterable[str]:
    """The time, or the rate in its place."""
    if clock is not None:
        yield line(key, clock.entry, clock.why, clock.question, indent)
