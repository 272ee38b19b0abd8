"""The run that the jobs of a sweep belong to."""

from contextlib import suppress

from learn.tracking.store import Store, lost

SWEEP = "STRAIN_WAVE_GEARS_SWEEP"  # environment variable that Hydra sets for every job: id of its parent run


def open_sweep(store: Store, study: str, grid: str) -> str:
    """Open the parent run of the jobs of a study on a grid, create it if it is new, and return its id."""
    run_id = find_sweep(store, study, grid)
    if run_id is None:
        tags = {"kind": "sweep", "study": study, "grid": grid}
        return str(store.client.create_run(store.experiment_id, tags=tags, run_name=f"{study} {grid}").info.run_id)
    store.client.update_run(run_id, "RUNNING")
    return run_id


def find_sweep(store: Store, study: str, grid: str) -> str | None:
    """The id of the run of a study on a grid, or None before the first sweep."""
    query = f"tags.kind = 'sweep' and tags.study = '{study}' and tags.grid = '{grid}'"
    found = store.client.search_runs([store.experiment_id], query, order_by=["attributes.start_time DESC"])
    return str(found[0].info.run_id) if found else None


def close_sweep(store: Store, run_id: str) -> None:
    """Mark the run of a sweep as finished; jobs of another sweep of the same study may still join it.

    If the server has gone away, the upload of the jobs does this later.
    """
    with suppress(*lost()):
        store.client.set_terminated(run_id)
