"""MLflow's page for the runs of a store: one link for each experiment, printed once the server answers."""

from functools import partial

from learn.tracking.server import free_port, run_mlflow, until_stopped
from learn.tracking.store import Store


def serve(store: Store, host: str, port: int | str) -> None:
    """Run MLflow's page for a local store until it is interrupted; with a server, only print the links.

    Parameters
    ----------
    store : Store
    host : str
        Address at which the page is served.
    port : int or str
        Port at which the page is served.

    Raises
    ------
    ValueError
        If the port is not a number from 1 to 65535 or is in use, or the server of the store does not answer.
    RuntimeError
        If MLflow's server ends by itself.
    """
    if store.folder is None:
        _print_links(store, store.uri)
        return
    number = free_port(host, port)
    with until_stopped():
        ready = partial(_print_links, store, f"http://{host}:{number}")
        run_mlflow(store.uri, host, number, "--workers", "1", ready=ready)


def links(store: Store, server: str) -> dict[str, str]:
    """Address of every experiment that has runs, by name.

    Parameters
    ----------
    store : Store
    server : str
        Address of the MLflow server, such as ``http://127.0.0.1:5050``.
    """
    experiments = store.client.search_experiments(order_by=["name"])
    return {
        experiment.name: f"{server}/#/experiments/{experiment.experiment_id}/runs"
        for experiment in experiments
        if store.client.search_runs([experiment.experiment_id], max_results=1)
    }


def _print_links(store: Store, server: str) -> None:
    found = links(store, server)
    for name, address in found.items():
        print(f"{name}: {address}", flush=True)
    if not found:
        print(
            f"{store.folder or store.uri} holds no runs; 'make paper' and 'make loop' make some: {server}", flush=True
        )
