"""Limits of what is read: sizes of files and tables, and no file outside of the given folder."""

from pathlib import Path, PurePosixPath, PureWindowsPath

from swgsim.tables.file_defect import FileDefect, shown

# Of one file [byte] and [row]. The first limits text files, the second binary ones.
LARGEST_FILE = 2 * 2**30
MOST_ROWS = 50_000_000
MOST_FILES = 10_000

# Compressed numbers of 8 bytes may expand to so many times the size of the file, or to so many bytes of any file.
# Measured signals are compressed by less than 10; only a hostile file of a few kilobytes fills the memory.
MOST_EXPANSION = 100
ALWAYS_EXPANDED = 256 * 2**20

# Far beyond every channel in its unit; squares are still finite.
LARGEST_NUMBER = 1e15

# Finest step of a clock [s].
SMALLEST_STEP = 1e-12

# Fewer samples give no median and no order lines.
FEWEST_ROWS = 16


def require_readable(path: Path) -> None:
    """Raise a FileDefect unless a path is a regular file within the size limit."""
    if not path.is_file():
        raise FileDefect(str(path), "no file", "a regular file of that name")
    size = path.stat().st_size
    if size > LARGEST_FILE:
        raise FileDefect(str(path), f"{size} bytes", f"at most {LARGEST_FILE}: split the recording")


def require_rows(file: str, rows: int) -> None:
    """Raise a FileDefect unless a number of rows is within its limits."""
    if not FEWEST_ROWS <= rows <= MOST_ROWS:
        raise FileDefect(file, f"{rows} samples", f"from {FEWEST_ROWS} to {MOST_ROWS}")


def most_expanded(path: Path) -> int:
    """Bytes to which the compressed contents of a file may expand."""
    return min(LARGEST_FILE, max(ALWAYS_EXPANDED, MOST_EXPANSION * path.stat().st_size))


def require_expansion(path: Path, file: str, count: int) -> None:
    """Raise a FileDefect if a file claims more numbers than a file of its size holds.

    Parameters
    ----------
    path : Path
    file : str
        Name of the file in messages.
    count : int
        Numbers to read from it.
    """
    most = most_expanded(path)
    if 8 * count > most:
        found = f"{count} numbers in {path.stat().st_size} bytes"
        raise FileDefect(file, found, f"at most {most // 8}: write it less compressed, or split the recording")


def require_file_count(folder: Path, count: int) -> None:
    """Raise a FileDefect unless the number of recordings of a folder is within its limits."""
    if not 1 <= count <= MOST_FILES:
        raise FileDefect(str(folder), f"{count} recordings", f"from 1 to {MOST_FILES}")


def inside(folder: Path, name: str, table: str, row: int | None = None) -> Path:
    """The path of a file that a table names; it must be in the folder, also through links.

    Parameters
    ----------
    folder : Path
    name : str
        Its entry in the table.
    table : str
        Name of the table in messages.
    row : int, optional
        Its row.

    Raises
    ------
    FileDefect
        If the name is absolute, leads out of the folder or names no readable file.
    """
    parts = PurePosixPath(name.replace("\\", "/")).parts
    outside = ".." in parts or PurePosixPath(name).is_absolute() or PureWindowsPath(name).drive or "\\" in name
    if not name.isprintable() or not parts or outside:
        raise FileDefect(table, shown(name), "the name of a file inside the folder, such as a.csv", row, "file")
    path = folder / name
    try:
        path.resolve(strict=True)
    except (OSError, RuntimeError) as error:  # a name too long, or links in a circle
        expected = "the name of a file in the folder"
        raise FileDefect(table, f"{shown(name)}, which does not exist ({error})", expected, row, "file") from None
    if not path.resolve().is_relative_to(folder.resolve()):
        raise FileDefect(table, f"{shown(name)}, which leads outside", "a file inside the folder", row, "file")
    if not path.is_file():
        raise FileDefect(table, f"{shown(name)}, which does not exist", "the name of a file in the folder", row, "file")
    require_readable(path)
    return path
