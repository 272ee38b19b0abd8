"""Facts by patterns from the path of a file or from its text, such as its session, its run or its speed.

A regular expression of Python may never end on a short text, such as ``(a+)+b``. Those of RE2, which come with Arrow,
take a time in proportion to the text and refuse expressions that need much memory. They have no back references and no
look-around.
"""

from collections.abc import Sequence

from swgsim.common.checks import require_known
from swgsim.tables.file_defect import FileDefect, shown

# RE2's memory grows with the expression; those of the shipped sources have less than 150 characters.
LONGEST_PATTERN = 1000


def require_pattern(pattern: str, groups: Sequence[str]) -> None:
    """Raise a ValueError unless a pattern is a regular expression with known groups."""
    if len(pattern) > LONGEST_PATTERN:
        raise ValueError(f"a pattern has {len(pattern)} characters, must have at most {LONGEST_PATTERN}")
    require_known(f"the groups of {shown(pattern)}", _found(pattern, "")[1], groups)


def path_groups(pattern: str, name: str) -> dict[str, str] | None:
    """The groups of a path, without empty ones; None if the path does not match.

    Parameters
    ----------
    pattern : str
        Regular expression for the whole path.
    name : str
        Path relative to the folder, with slashes.

    Raises
    ------
    FileDefect
        If a group is not printable.

    Examples
    --------
    >>> path_groups(r"(?P<n_in_rpm>\\d+)rpm_(?P<T_out_nm>\\d+)Nm.csv", "2000rpm_39Nm.csv")
    {'n_in_rpm': '2000', 'T_out_nm': '39'}
    """
    return groups_in(rf"\A(?:{pattern})\z", name, name)


def groups_in(pattern: str, text: str, name: str) -> dict[str, str] | None:
    """The groups of the first place in a text that matches, without empty ones; None if there is none.

    Parameters
    ----------
    pattern, text : str
    name : str
        Name of the file in messages.

    Raises
    ------
    FileDefect
        If a group is not printable.
    """
    found, _ = _found(pattern, text)
    if found is None:
        return None
    for group, said in found.items():
        if not said.isprintable():
            raise FileDefect(name, f"{shown(said)} as its {group}", "printable text")
    return {group: said for group, said in found.items() if said}


def _found(pattern: str, text: str) -> tuple[dict[str, str] | None, list[str]]:
    """The groups of a text, None if it does not match, and the names of all groups."""
    import pyarrow  # type: ignore[import-untyped]
    from pyarrow import compute

    try:
        found = compute.extract_regex(pyarrow.array([text], pyarrow.string()), pattern=pattern)
    except (pyarrow.ArrowException, UnicodeError) as error:
        raise ValueError(
            f"the pattern {shown(pattern)} is no regular expression of RE2 with named groups: {error}"
        ) from None
    return found[0].as_py(), [field.name for field in found.type]
