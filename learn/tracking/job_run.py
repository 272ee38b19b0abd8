"""The run of one job; if the server goes away meanwhile, the results are kept on disk until they are uploaded.

If a folder takes no more runs, the error names another choice.
"""

import logging
import os
import tempfile
import time
import uuid
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from learn.tracking.store import Store, StoreAway, lost
from learn.tracking.sweeps import SWEEP

log = logging.getLogger(__name__)


@dataclass
class Results:
    """Results of a job; the keys of pictures (PNG) and tables are their paths among the artifacts."""

    metrics: Mapping[str, float] = field(default_factory=dict)
    pictures: Mapping[str, bytes] = field(default_factory=dict)
    tables: Mapping[str, pd.DataFrame] = field(default_factory=dict)

    def record(
        self, metrics: Mapping[str, float], pictures: Mapping[str, bytes], tables: Mapping[str, pd.DataFrame]
    ) -> None:
        """Set all results; they are written when the job ends."""
        self.metrics, self.pictures, self.tables = metrics, pictures, tables

    def write(self, store: Store, run_id: str) -> None:
        """Fill a run and finish it: metrics in one transaction, tables as Parquet."""
        from mlflow.entities import Metric

        now = _now()
        store.client.log_batch(run_id, metrics=[Metric(name, value, now, 0) for name, value in self.metrics.items()])
        contents: dict[str, bytes | pd.DataFrame] = {**self.pictures, **self.tables}
        with tempfile.TemporaryDirectory() as folder:
            for path, content in contents.items():
                file = Path(folder) / Path(path).name
                if isinstance(content, bytes):
                    file.write_bytes(content)
                else:
                    content.to_parquet(file)
                store.client.log_artifact(run_id, str(file), str(Path(path).parent))
        store.client.set_terminated(run_id)


@contextmanager
def job_run(
    store: Store, name: str, key: str, parameters: Mapping[str, Any], config: Mapping[str, Any], tags: Mapping[str, str]
) -> Iterator[Results]:
    """The run of one job: finished at the end, failed after an exception, and left running by a killed job.

    The environment variable ``SWEEP`` names its parent run; a job outside a sweep has no parent. If the server does not
    take the run, the store's pending store keeps it; both copies have the same tag ``origin``.

    Parameters
    ----------
    store : Store
    name : str
        Name of the run.
    key : str
        Key of :func:`finished_metrics`.
    parameters : mapping
        Parameters by which the run is looked up and compared.
    config : mapping
        Resolved configuration, kept as ``config.yaml``.
    tags : mapping
        Further facts.

    Raises
    ------
    StoreAway
        If a folder takes no runs.
    """
    from mlflow.entities import Param

    start, parent = _now(), os.environ.get(SWEEP)
    facts = {"kind": "job", "key": key, "origin": uuid.uuid4().hex, **tags}
    facts |= {"mlflow.parentRunId": parent} if parent else {}

    def begin(store: Store) -> str:
        """Open a run in a store and return its id."""
        run_id = str(store.client.create_run(store.experiment_id, start, facts, name).info.run_id)
        store.client.log_batch(run_id, params=[Param(each, str(value)) for each, value in parameters.items()])
        store.client.log_dict(run_id, dict(config), "config.yaml")
        return run_id

    try:
        run_id = begin(store)
    except lost() as error:
        store = _pending(store, name, error)
        run_id = begin(store)
    results = Results()
    try:
        yield results
        try:
            results.write(store, run_id)
        except lost() as error:
            pending = _pending(store, name, error)
            results.write(pending, begin(pending))
    except BaseException:
        with suppress(*lost()):
            store.client.set_terminated(run_id, "FAILED")
        raise


def _pending(store: Store, name: str, error: Exception) -> Store:
    """The store that keeps the job instead, with a warning; without one the error is raised, with a remedy."""
    if store.pending is None:
        if store.folder is None or isinstance(error, StoreAway) or _is_defect(error):
            raise error
        raise store.away(error) from error
    log.warning(
        "%s: the MLflow server at %s has gone away; the results are kept in %s. When it is back, upload them with "
        "'swg upload tracking.uri=%s tracking.pending=%s'. The error was: %s",
        name, store.uri, store.pending.folder, store.uri, store.pending.folder, str(error)[:300],
    )  # fmt: skip
    return store.pending


def _is_defect(error: Exception) -> bool:
    """Whether no store takes a run, such as one with a wrong name."""
    return getattr(error, "error_code", None) == "INVALID_PARAMETER_VALUE"


def _now() -> int:
    return int(1000 * time.time())
