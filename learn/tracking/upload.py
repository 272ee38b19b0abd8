"""Bringing the runs of a local store to a server: whole or not at all, and none twice."""

import logging
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

from learn.tracking.store import Store
from learn.tracking.sweeps import close_sweep, find_sweep
from swgsim.common.files import sole_maker

if TYPE_CHECKING:
    from mlflow.entities import Run

MOST = 50_000  # runs that MLflow lists at once
FINISHED = "attributes.status = 'FINISHED'"
PARENT = "mlflow.parentRunId"

log = logging.getLogger(__name__)


def upload(server: Store) -> int:
    """Bring the finished runs of all experiments that wait for a server to it, and return how many were new to it.

    They stay where they are as well. A second upload at the same time waits for the first.

    Raises
    ------
    ValueError
        If there is no local store where runs would wait, or the server does not answer.
    """
    waiting = server.pending
    if waiting is None or waiting.folder is None or not waiting.exists:
        raise ValueError(
            f"no runs wait for {server.uri} in {waiting.folder if waiting else None}: "
            "give tracking=server and, as tracking.pending, the folder of a local store"
        )
    with sole_maker(waiting.folder / "upload", wait=True):
        names = [experiment.name for experiment in waiting.client.search_experiments()]
        return sum(Upload(*(replace(each, experiment=name) for each in (waiting, server))).run() for name in names)


@dataclass(frozen=True)
class Upload:
    """Of one experiment, from a local store to a server."""

    source: Store
    server: Store

    def run(self) -> int:
        """Bring the jobs that the server lacks, with their sweeps, and return how many."""
        waiting = _search(self.source, "kind = 'job'", FINISHED)
        missing = [job for job in waiting if self._lacks(job)]
        for job in missing:
            self._bring(job)
        parents = {self._parent(sweep) for sweep in {job.data.tags.get(PARENT) for job in waiting}}
        for sweep in _search(self.server, "kind = 'sweep'", "attributes.status = 'RUNNING'"):
            if sweep.info.run_id in parents:  # left open when the server went away, or by a killed upload
                close_sweep(self.server, sweep.info.run_id)
        return len(missing)

    def _lacks(self, run: "Run") -> bool:
        """Whether the server lacks a run; what a lost job or a killed upload left of it there is removed."""
        there = _search(self.server, f"origin = '{_origin(run)}'")
        if any(each.info.status == "FINISHED" for each in there):
            return False
        for half in there:
            self.server.client.delete_run(half.info.run_id)
        return True

    def _bring(self, run: "Run") -> None:
        """Copy the run of a job into that of its sweep on the server."""
        parent = self._parent(run.data.tags.get(PARENT))
        self._copy(run, {PARENT: parent} if parent else {})
        log.info("%s: uploaded", run.info.run_name)

    def _parent(self, run_id: str | None) -> str | None:
        """The sweep on the server that stands for a run; one that is no local sweep is the server's own."""
        sweep = self._sweeps.get(run_id)
        if sweep is None:
            return run_id
        return find_sweep(self.server, sweep.data.tags["study"], sweep.data.tags["grid"]) or self._copy(sweep, {})

    @cached_property
    def _sweeps(self) -> dict[str | None, "Run"]:
        return {sweep.info.run_id: sweep for sweep in _search(self.source, "kind = 'sweep'")}

    def _copy(self, run: "Run", tags: dict[str, str]) -> str:
        """Copy a run; the last step, which makes it a finished one, comes when all else is there."""
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
    return list(store.client.search_runs([store.experiment_id], query, max_results=MOST, order_by=order))


def _origin(run: "Run") -> str:
    """What the copies of a run have in common; runs that are older than this tag have their id."""
    return str(run.data.tags.get("origin", run.info.run_id))
