"""Names of columns that differ by file, such as X097_time and X098_time, as patterns."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

from swgsim.drafting.file_contents import FileContents

NUMBER = re.compile(r"\d+")


def by_pattern(contents: Mapping[str, FileContents]) -> dict[str, FileContents]:
    """Files with columns by patterns, where their names differ by a number only; else the files as they are.

    Parameters
    ----------
    contents : mapping of str to FileContents
        Name of a file to what it shows.
    """
    files = list(contents.values())
    names = [[str(each.column) for each in one.columns] for one in files]
    patterns = _patterns(names)
    if len({tuple(row) for row in names}) < 2 or patterns is None:
        return dict(contents)
    found = {}
    for file, one in contents.items():
        columns = tuple(
            replace(each, column=pattern) if "*" in pattern else each
            for each, pattern in zip(one.columns, patterns, strict=True)
        )
        found[file] = replace(one, columns=columns)
    return found


def _patterns(names: Sequence[Sequence[str]]) -> list[str] | None:
    """One pattern for each column; None if the names differ by more, or a pattern means two columns.

    >>> _patterns([["X097_time", "X097_s0"], ["X105_time", "X105_s0"]])
    ['X*_time', 'X*_s0']
    """
    if len({tuple(NUMBER.sub("0", name) for name in row) for row in names}) > 1:
        return None
    patterns = []
    for same in zip(*names, strict=True):
        numbers = list(zip(*(NUMBER.findall(name) for name in same), strict=True))
        parts = NUMBER.split(same[0])
        between = ["*" if len(set(each)) > 1 else each[0] for each in numbers]
        patterns.append("".join(part + number for part, number in zip(parts, [*between, ""], strict=True)))
    return patterns if len(set(patterns)) == len(patterns) else None
