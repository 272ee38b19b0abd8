"""What the path of a file says: its session, its run and perhaps the joint that was moved.

The regular expressions of Python may take for ever on a short text, as ``(a+)+b`` does. Those of RE2, which come with
Arrow, take a time in proportion to the text, refuse expressions that would need much memory, and know no back
references and no look-around; so an expression from anybody can be tried on the path of any file.
"""

from swgsim.common.checks import require_known
from swgsim.recordings.files.file_defect import FileDefect, shown

GROUPS = ("session", "run", "joint")
# What RE2 compiles grows with the expression; those of the shipped sources have less than 150 characters.
LONGEST_PATTERN = 1000


def require_pattern(pattern: str) -> None:
    """Raise a ValueError unless a pattern has the groups ``session`` and ``run``, and no others but ``joint``."""
    if len(pattern) > LONGEST_PATTERN:
        raise ValueError(f"path has {len(pattern)} characters, must have at most {LONGEST_PATTERN}")
    _, groups = _found(pattern, "")
    require_known("the groups of path", groups, GROUPS)
    for name in ("session", "run"):
        if name not in groups:
            raise ValueError(f"path {pattern!r} has no group (?P<{name}>...): it is the part that says the {name}")


def said_by(pattern: str, name: str) -> dict[str, str]:
    """The groups of a path, without those that are empty.

    Parameters
    ----------
    pattern : str
        Of the whole path.
    name : str
        Path relative to the folder, with slashes.

    Raises
    ------
    FileDefect
        If the path is not as the pattern says, or says no session or run.
    """
    found, _ = _found(rf"\A(?:{pattern})\z", name)
    if found is None:
        raise FileDefect(name, "a path that does not match 'path' of the source", f"one that matches {pattern}")
    for group in ("session", "run"):
        if not found[group] or not found[group].isprintable():
            raise FileDefect(name, f"{shown(found[group])} as its {group}", "printable text")
    return {group: text for group, text in found.items() if text}


def _found(pattern: str, text: str) -> tuple[dict[str, str] | None, list[str]]:
    """What a text says, if it matches, and the names of all groups."""
    import pyarrow  # type: ignore[import-untyped]
    from pyarrow import compute

    try:
        found = compute.extract_regex(pyarrow.array([text], pyarrow.string()), pattern=pattern)
    except (pyarrow.ArrowException, UnicodeError) as error:
        raise ValueError(f"path {shown(pattern)} is no regular expression of RE2 with named groups: {error}") from None
    return found[0].as_py(), [field.name for field in found.type]
