"""Local MLflow stores from a copy of an empty database, which MLflow takes seconds to create."""

import shutil
from importlib.metadata import version
from pathlib import Path

from learn import tracking
from learn.tracking.store import DATABASE, _create

EMPTY = Path(__file__).parents[1] / ".pytest_cache" / f"mlflow-{version('mlflow')}.db"


def prepared(folder: Path) -> Path:
    """The folder, with an empty database unless it has one."""
    if not EMPTY.exists():
        _create(EMPTY)  # complete or absent, also if two processes do so
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / DATABASE).exists():
        shutil.copyfile(EMPTY, folder / DATABASE)
    return folder


def store_in(folder: Path) -> tracking.Store:
    """A local store in a folder, with an empty database unless it has one."""
    return tracking.local_store(str(prepared(folder)))
