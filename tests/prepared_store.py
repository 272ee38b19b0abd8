"""Local MLflow stores from a copy of an empty database, which MLflow takes seconds to create."""

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from learn import tracking
from learn.tracking.store import DATABASE, _create


@cache
def _empty() -> bytes:
    with TemporaryDirectory() as folder:
        path = Path(folder) / DATABASE
        _create(path)
        return path.read_bytes()


def prepared(folder: Path) -> Path:
    """The folder, with an empty database."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / DATABASE).write_bytes(_empty())
    return folder


def store_in(folder: Path) -> tracking.Store:
    """A local store in a folder, with an empty database unless there is one."""
    return tracking.local_store(str(folder if (folder / DATABASE).exists() else prepared(folder)))
