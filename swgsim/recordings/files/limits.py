"""What is read at most, and from where: no file outside the folder that was given, none beyond a declared size."""

from pathlib import Path, PurePosixPath, PureWindowsPath

from swgsim.recordings.files.file_defect import FileDefect, shown

# Of one file. A CSV of 5e7 rows would be larger, so that this limit is the one for text and the next for binary files.
LARGEST_FILE = 2 * 2**30
MOST_ROWS = 50_000_000
MOST_FILES = 10_000

# Numbers may lie compressed: to 8 bytes each they may grow so many times, or to so many bytes whatever the file's size.
# Measured signals shrink by less than 10; a file of a few kilobytes that fills the memory was made for that.
MOST_EXPANSION = 100
ALWAYS_EXPANDED = 256 * 2**20

# No channel in its unit comes near it, and squares of it can still be computed with.
LARGEST_NUMBER = 1e15

# No clock resolves less [s].
SMALLEST_STEP = 1e-12

# Medians and order lines of fewer samples say nothing.
FEWEST_ROWS = 16


def require_readable(path: Path) -> None:
    """Raise unless a path is a regular file of a size that is read.

    Raises
    ------
    FileDefect
        Also where there is no such file.
    """
    if not path.is_file():
        raise FileDefect(str(path), "no file", "a regular file of that name")
    size = path.stat().st_size
    if size > LARGEST_FILE:
        raise FileDefect(str(path), f"{size} bytes", f"at most {LARGEST_FILE}: split the recording")


def require_rows(file: str, rows: int) -> None:
    """Raise a FileDefect unless that many rows are enough and not too many."""
    if not FEWEST_ROWS <= rows <= MOST_ROWS:
        raise FileDefect(file, f"{rows} samples", f"from {FEWEST_ROWS} to {MOST_ROWS}")


def most_expanded(path: Path) -> int:
    """Bytes that what lies compressed in a file may grow to."""
    return min(LARGEST_FILE, max(ALWAYS_EXPANDED, MOST_EXPANSION * path.stat().st_size))


def require_expansion(path: Path, file: str, count: int) -> None:
    """Raise a FileDefect if a file says that it holds more numbers than one of its size does.

    Parameters
    ----------
    path : Path
    file : str
        What messages call it.
    count : int
        Numbers that are to be read from it.
    """
    most = most_expanded(path)
    if 8 * count > most:
        found = f"{count} numbers in {path.stat().st_size} bytes"
        raise FileDefect(file, found, f"at most {most // 8}: write it less compressed, or split the recording")


def require_file_count(folder: Path, count: int) -> None:
    """Raise a FileDefect unless a folder holds at least one recording and not too many."""
    if not 1 <= count <= MOST_FILES:
        raise FileDefect(str(folder), f"{count} recordings", f"from 1 to {MOST_FILES}")


def inside(folder: Path, name: str, table: str, row: int | None = None) -> Path:
    """The path of a file that a table names, which must lie in its folder, links followed.

    Parameters
    ----------
    folder : Path
    name : str
        As the table says it.
    table : str
        Which table says it.
    row : int, optional
        Where it says it.

    Raises
    ------
    FileDefect
        If the name is absolute, leads outside or names no readable file.
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
