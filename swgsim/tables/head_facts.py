"""Facts from the lines before the numbers of a text file, such as its speed or its session."""

from itertools import islice
from pathlib import Path

from swgsim.tables import binary
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.formats.spreadsheet import is_spreadsheet
from swgsim.tables.layout import Layout
from swgsim.tables.path_pattern import groups_in
from swgsim.tables.table_map import TableMap
from swgsim.tables.text import start_of
from swgsim.tables.text_stream import number_of, opened


def head_facts(path: Path, name: str, table: TableMap) -> dict[str, str]:
    """The groups of the patterns ``head`` of a map; none if it has no patterns.

    Parameters
    ----------
    path : Path
    name : str
        Name of the file in messages.
    table : TableMap

    Raises
    ------
    FileDefect
        If the file is no text, or a pattern is not in the lines before its first row of numbers.
    """
    if not table.head:
        return {}
    if table.layout.raw or binary.is_binary(path) or is_spreadsheet(path):
        raise FileDefect(name, "no lines of text before the numbers", "a text file, where a map has 'head'")
    rows = start_of(path, name, table.layout).row - 1
    with opened(path, table.layout) as stream:
        text = "".join(islice(stream, rows))
    found: dict[str, str] = {}
    for pattern in table.head:
        groups = groups_in(pattern, text, name)
        if groups is None:
            raise FileDefect(name, f"nothing like {shown(pattern)} in rows 1 to {rows}", "what 'head' of the map says")
        found |= groups
    return {fact: _with_point(said, table.layout) for fact, said in found.items()}


def _with_point(said: str, layout: Layout) -> str:
    """A number as it is written with a decimal point and without separators of thousands; other text as it is.

    >>> _with_point("1.024,5", Layout(decimal=",", thousands=".")), _with_point("007", Layout())
    ('1024.5', '007')
    """
    value = number_of(said, layout)
    return said if value is None or value == number_of(said, Layout()) else f"{value:.15g}"
