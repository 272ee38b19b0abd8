"""Files of a folder, and those that hold numbers by their endings."""

import os
from pathlib import Path

from swgsim.tables.binary import HERE, IN_CHILD
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.spreadsheet import ENDINGS as OF_SPREADSHEETS

# Files that end in .txt or .log are often notes: they are read where a map names them.
OF_TEXT = (".csv", ".tsv", ".asc", ".dat", ".lvm")
ENDINGS = (*HERE, *IN_CHILD, *OF_SPREADSHEETS, *OF_TEXT, *(f"{ending}.gz" for ending in OF_TEXT))
# Largest number of folders and files in a folder of recordings.
MOST_ENTRIES = 200_000


def is_data(name: str) -> bool:
    """Whether a file holds numbers by its ending."""
    return name.lower().endswith(ENDINGS)


def files_of(folder: Path) -> list[str]:
    """Paths of all files in a folder and its folders, with slashes and in order; links to folders are not followed.

    Raises
    ------
    FileDefect
        If the folder has too many entries.
    """
    found, entries = [], 0
    for place, folders, files in os.walk(folder):
        entries += len(folders) + len(files)
        if entries > MOST_ENTRIES:
            raise FileDefect(str(folder), f"more than {MOST_ENTRIES} files and folders", "a folder of recordings")
        for file in files:
            found.append((Path(place) / file).relative_to(folder).as_posix())
    return sorted(found)
