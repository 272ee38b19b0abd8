"""Queries of finished runs, their metrics and tables."""

import os
import tempfile
from typing import Any

import pandas as pd

from learn.tracking.store import Store, lost
from learn.tracking.sweeps import SWEEP


def finished_metrics(store: Store, key: str) -> dict[str, float] | None:
    """The metrics of a finished job, whether it waits for upload or not, or None if no job has this key.

    Raises
    ------
    StoreAway
        If the store does not answer. Within a sweep the jobs go on instead, and wait for upload.
    """
    waiting = _metrics(store.pending, key) if store.pending and store.pending.exists else None
    try:
        return waiting or _metrics(store, key)
    except lost():
        if SWEEP not in os.environ or store.pending is None:
            raise
        return None


def _metrics(store: Store, key: str) -> dict[str, float] | None:
    query = f"tags.kind = 'job' and tags.key = '{key}' and attributes.status = 'FINISHED'"
    runs = store.client.search_runs([store.experiment_id], query)
    return dict(runs[0].data.metrics) if runs else None


def finished_runs(store: Store, **parameters: str) -> pd.DataFrame:
    """The newest finished run of every configuration, one row each, newest first.

    Parameters
    ----------
    store : Store
    **parameters : str
        Values that parameters must have, such as ``grid="paper"``.

    Returns
    -------
    DataFrame
        Columns are the parameters (text), the metrics (numbers), ``data_digest``, ``code_version`` (empty where a run
        has none) and ``run_id``; empty if there is no run.
    """
    conditions = [f"params.{name} = '{value}'" for name, value in parameters.items()]
    query = " and ".join(["tags.kind = 'job'", "attributes.status = 'FINISHED'", *conditions])
    runs = store.client.search_runs(
        [store.experiment_id], query, max_results=50_000, order_by=["attributes.start_time DESC"]
    )
    newest: dict[tuple[tuple[str, str], ...], Any] = {}
    for run in runs:
        newest.setdefault(tuple(sorted(run.data.params.items())), run)
    return pd.DataFrame(
        [
            {
                **r.data.params, **r.data.metrics, "data_digest": r.data.tags["data_digest"],
                "code_version": r.data.tags.get("code_version", ""), "run_id": r.info.run_id,
            }
            for r in newest.values()
        ]
    )  # fmt: skip


def table_of(store: Store, run_id: str, path: str) -> pd.DataFrame:
    """A table that a run keeps among its artifacts."""
    with tempfile.TemporaryDirectory() as folder:
        return pd.read_parquet(store.client.download_artifacts(run_id, path, folder))
