"""MLflow behind a few functions: the store, runs of jobs and sweeps, queries, a team's server and uploads to it."""

import os

os.environ.setdefault("MLFLOW_DISABLE_TELEMETRY", "true")  # read when mlflow is imported
os.environ.setdefault("MLFLOW_HTTP_REQUEST_MAX_RETRIES", "2")  # a lost server is noticed in seconds, not minutes
os.environ.setdefault("MLFLOW_HTTP_REQUEST_TIMEOUT", "20")  # [s]
os.environ.setdefault("MLFLOW_ENABLE_ARTIFACTS_PROGRESS_BAR", "false")  # one for every table of a report

from learn.tracking.job_run import Results, job_run
from learn.tracking.queries import finished_metrics, finished_runs, table_of
from learn.tracking.store import EXPERIMENT, Store, StoreAway, local_store, server_store
from learn.tracking.sweeps import SWEEP, close_sweep, find_sweep, open_sweep
from learn.tracking.upload import upload

__all__ = [
    "EXPERIMENT",
    "SWEEP",
    "Results",
    "Store",
    "StoreAway",
    "close_sweep",
    "find_sweep",
    "finished_metrics",
    "finished_runs",
    "job_run",
    "local_store",
    "open_sweep",
    "server_store",
    "table_of",
    "upload",
]
