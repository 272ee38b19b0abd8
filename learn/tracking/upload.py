"""Uploads the runs of a local store to a server: each run completely or not at all, and none twice."""

import logging
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

from learn.tracking.store import Store
from learn.tracking.sweeps import close_sweep, find_sweep
from swgsim.common.files import sole_maker

if TYPE_CHECKING:
    from mlflow.entities import Run

MOST_RUNS = 50_000  # runs that MLflow lists at once
FINISHED = "attributes.status = 'FINISHED'"
PARENT = "mlflow.parentRunId"

log = logging.getLogger(__name__)


def upload(server: Store) -> int:
    """Upload the finished runs of all experiments of a pending store, and return how many were new to the server.

    The pending store keeps them as well. A second upload at the same time waits for the first.

    Raises
    ------
    ValueError
        If there is no pending store, or it has no finished run, or one of both stores does not answer.
    """
    waiting = server.pending
    if waiting is None or waiting.folder is None or not waiting.exists:
        raise ValueError(
            f"no runs to upload to {server.uri} in {waiting.folder if waiting else None}: "
            f"'swg upload tracking.uri={server.uri} tracking.pending=FOLDER' uploads those of a local store"
        )
    local = waiting.client  # a folder that cannot be used is named first
    with sole_maker(waiting.folder / "upload", wait=True):
        names = [experiment.name for experiment in local.search_experiments()]
        uploads = [Upload(*(replace(each, experiment=name) for each in (waiting, server))) for name in names]
        if not any(each.jobs for each in uploads):
            raise ValueError(f"{waiting.folder} has no finished run to upload: give another folder as tracking.pending")
        return sum(each.run() for each in uploads)


@dataclass(frozen=True)
class Upload:
    """Upload of one experiment from a local store to a server."""

    source: Store
    server: Store

    @cached_property
    def jobs(self) -> "list[Run]":
        """The finished jobs of the local store."""
        return _search(self.source, "kind = 'job'", FINISHED)

    def run(self) -> int:
        """Copy the jobs that the server lacks, with their sweeps, and return how many."""
        missing = [job for job in self.jobs if self._lacks(job)]
        for job in missing:
            self._bring(job)
        parents = {self._parent(sweep) for sweep in {job.data.tags.get(PARENT) for job in self.jobs}}
        for sweep in _search(self.server, "kind = 'sweep'", "attributes.status = 'RUNNING'"):
            if sweep.info.run_id in parents:  # left open when the server went away, or by a killed upload
                close_sweep(self.server, sweep.info.run_id)
        return len(missing)

    def _lacks(self, run: "Run") -> bool:
        """Whether the server lacks a run; an incomplete copy of a lost job or a killed upload is removed."""
        copies = _search(self.server, f"origin = '{_origin(run)}'")
        if any(each.info.status == "FINISHED" for each in copies):
            return False
        for incomplete in copies:
            self.server.client.delete_run(incomplete.info.run_id)
        return True

    def _bring(self, run: "Run") -> None:
        """Copy the run of a job into that of its sweep on the server."""
        parent = self._parent(run.data.tags.get(PARENT))
        self._copy(run, {PARENT: parent} if parent else {})
        log.info("%s: uploaded", run.info.run_name)

    def _parent(self, run_id: str | None) -> str | None:
        """The sweep on the server for a parent run; a run that is no local sweep is the server's own."""
        sweep = self._sweeps.get(run_id)
        if sweep is None:
            return run_id
        return find_sweep(self.server, sweep.data.tags["study"], sweep.data.tags["grid"]) or self._copy(sweep, {})

    @cached_property
    def _sweeps(self) -> dict[str | None, "Run"]:
        return {sweep.info.run_id: sweep for sweep in _search(self.source, "kind = 'sweep'")}

    def _copy(self, run: "Run", tags: dict[str, str]) -> str:
        """Copy a run; it becomes a finished one in the last step."""
        from mlflow.entities import Param

        source, server, info = self.source.client, self.server.client, run.info
        tags = {**run.data.tags, "origin": _origin(run), **tags}
        copy = str(server.create_run(self.server.experiment_id, info.start_time, tags, info.run_name).info.run_id)
        metrics = [metric for name in run.data.metrics for metric in source.get_metric_history(info.run_id, name)]
        server.log_batch(copy, metrics, [Param(*each) for each in run.data.params.items()])
        if source.list_artifacts(info.run_id):
            server.log_artifacts(copy, source.download_artifacts(info.run_id, ""))
        server.set_terminated(copy, end_time=info.end_time)
        return copy


def _search(store: Store, tag: str, *more: str) -> "list[Run]":
    query = " and ".join([f"tags.{tag}", *more])
    order = ["attributes.start_time ASC"]
    return list(store.client.search_runs([store.experiment_id], query, max_results=MOST_RUNS, order_by=order))


def _origin(run: "Run") -> str:
    """Tag that the copies of a run share; a run without it has its id instead."""
    return str(run.data.tags.get("origin", run.info.run_id))
