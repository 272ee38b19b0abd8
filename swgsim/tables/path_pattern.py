"""Session, run and perhaps joint from the path of a file.

A regular expression of Python may never end on a short text, such as ``(a+)+b``. Those of RE2, which come with Arrow,
take a time in proportion to the text and refuse expressions that need much memory. They have no back references and no
look-around.
"""

from swgsim.common.checks import require_known
from swgsim.tables.file_defect import FileDefect, shown

GROUPS = ("session", "run", "joint")
# RE2's memory grows with the expression; those of the shipped sources have less than 150 characters.
LONGEST_PATTERN = 1000


def require_pattern(pattern: str) -> None:
    """Raise a ValueError unless a pattern has the groups ``session`` and ``run``, and at most ``joint`` besides."""
    if len(pattern) > LONGEST_PATTERN:
        raise ValueError(f"path has {len(pattern)} characters, must have at most {LONGEST_PATTERN}")
    _, groups = _found(pattern, "")
    require_known("the groups of path", groups, GROUPS)
    for name in ("session", "run"):
        if name not in groups:
            raise ValueError(f"path {pattern!r} has no group (?P<{name}>...): mark the part that is the {name}")


def path_groups(pattern: str, name: str) -> dict[str, str]:
    """The groups of a path, without empty ones.

    Parameters
    ----------
    pattern : str
        Regular expression for the whole path.
    name : str
        Path relative to the folder, with slashes.

    Raises
    ------
    FileDefect
        If the path does not match the pattern, or session or run are empty.
    """
    found, _ = _found(rf"\A(?:{pattern})\z", name)
    if found is None:
        raise FileDefect(name, "a path that does not match 'path' of the source", f"one that matches {pattern}")
    for group in ("session", "run"):
        if not found[group] or not found[group].isprintable():
            raise FileDefect(name, f"{shown(found[group])} as its {group}", "printable text")
    return {group: text for group, text in found.items() if text}


def _found(pattern: str, text: str) -> tuple[dict[str, str] | None, list[str]]:
    """The groups of a text, None if it does not match, and the names of all groups."""
    import pyarrow  # type: ignore[import-untyped]
    from pyarrow import compute

    try:
        found = compute.extract_regex(pyarrow.array([text], pyarrow.string()), pattern=pattern)
    except (pyarrow.ArrowException, UnicodeError) as error:
        raise ValueError(f"path {shown(pattern)} is no regular expression of RE2 with named groups: {error}") from None
    return found[0].as_py(), [field.name for field in found.type]
