"""``manifest.csv``: file and facts of every recording of a folder."""

import csv
import io
from collections.abc import Iterable
from pathlib import Path

from swgsim.recordings.files import facts
from swgsim.tables.file_defect import FIRST_ROW, FileDefect, shown
from swgsim.tables.limits import inside, require_file_count, require_readable

NAME = "manifest.csv"
# Bytes, more than the facts of 10 000 recordings have; it is read at once.
MOST_BYTES = 32 * 2**20

# Columns in the order in which they are written.
COLUMNS = ("recording", "file", *(name for name in facts.KNOWN if name != "recording"))


def read(folder: Path) -> list[tuple[Path, dict[str, object]]]:
    """The file and the facts of every recording of a folder.

    Raises
    ------
    FileDefect
        If the manifest is missing or not a table, lacks a column, has an unknown column or a wrong fact, or if its
        files and those of the folder differ.
    """
    path = folder / NAME
    require_readable(path)
    if path.stat().st_size > MOST_BYTES:
        raise FileDefect(NAME, f"{path.stat().st_size} bytes", f"at most {MOST_BYTES}")
    rows = _rows(path)
    require_file_count(folder, len(rows) - 1)
    header = [cell.strip() for cell in rows[0]]
    _require_header(header)
    found: list[tuple[Path, dict[str, object]]] = []
    taken: dict[Path, int] = {}
    names: dict[object, int] = {}
    for row, cells in enumerate(rows[1:], FIRST_ROW):
        if len(cells) != len(header):
            raise FileDefect(NAME, f"{len(cells)} cells", f"{len(header)}, as the header has", row)
        given: dict[str, object] = dict(zip(header, (cell.strip() for cell in cells), strict=True))
        file = inside(folder, str(given.pop("file")), NAME, row)
        known = facts.parse(given, NAME, row)
        first = taken.setdefault(file.resolve(), row)
        if first != row:
            raise FileDefect(NAME, f"{shown(file.name)} as in row {first}", "another file", row, "file")
        first = names.setdefault(known["recording"], row)
        if first != row:
            found_name = f"{shown(known['recording'])} as in row {first}"
            raise FileDefect(NAME, found_name, "another name", row, "recording")
        found.append((file, known))
    for file in sorted(folder.rglob("*")):
        if file.suffix.lower() == ".csv" and _place(file) not in taken and file != path:
            raise FileDefect(str(file.relative_to(folder)), "no row for this file in the manifest", "one row per file")
    return found


def _place(file: Path) -> Path:
    """Resolved path of a file; links in a circle have none and stay as they are."""
    try:
        return file.resolve()
    except (OSError, RuntimeError):
        return file


def text(rows: Iterable[tuple[str, dict[str, object]]]) -> str:
    """The manifest of files and the facts of their recordings."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
    writer.writeheader()
    for file, known in rows:
        writer.writerow({"file": file, **known})
    return stream.getvalue()


def _rows(path: Path) -> list[list[str]]:
    """Cells of all rows but blank ones at the end."""
    try:
        rows = list(csv.reader(io.StringIO(path.read_text(encoding="utf-8-sig"), newline=""), strict=True))
    except (csv.Error, UnicodeDecodeError) as error:
        raise FileDefect(NAME, f"no table ({error})", "a CSV file in UTF-8") from None
    while rows and not any(rows[-1]):
        rows.pop()
    if not rows:
        raise FileDefect(NAME, "an empty file", f"a header {','.join(COLUMNS)}", 1)
    return rows


def _require_header(header: list[str]) -> None:
    """Raise unless the header has all needed columns, none twice and none unknown."""
    missing = [name for name in ("file", *facts.NEEDED) if name not in header]
    if missing:
        raise FileDefect(NAME, f"no column {', '.join(missing)}", f"the columns {','.join(COLUMNS)}", 1)
    for i, name in enumerate(header):
        if name not in COLUMNS or name in header[:i]:
            found = f"{'unknown' if name not in COLUMNS else 'twice the'} column {shown(name)}"
            raise FileDefect(NAME, found, f"the columns {','.join(COLUMNS)}", 1)
