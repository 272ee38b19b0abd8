"""The page on which MLflow opens: saved views with the metrics and parameters that matter.

MLflow (3.15 and later) keeps a saved view as a tag of the experiment: a header and, compressed, the state of the
table. The format is not documented; ``tests/test_tracking.py`` guards it.
"""

import base64
import json
import time
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from learn.tracking import Store
from learn.tracking.server import run_mlflow, until_stopped

METRICS = ("test_score", "train_score", "fit_seconds")
WHAT = ("classifier", "features", "protocol", "condition")  # the name of a run begins with its study
SIZES = ("hidden_layers", "neurons", "kernel", "trees", "depth", "neighbours")


@dataclass(frozen=True)
class View:
    """A saved view of the table of runs: which runs, in which order, with which parameters beside the metrics."""

    key: str
    name: str
    filter: str
    order_by: str
    parameters: tuple[str, ...]


PAPER = "tags.kind = 'job' and params.grid = 'paper'"
OTHER = "tags.kind = 'job' and params.grid != 'paper'"
SCORES = View("scores", "Scores", PAPER, "metrics.`test_score`", WHAT)
OTHER_GRIDS = View("other_grids", "Scores on other grids", OTHER, "metrics.`test_score`", ("grid", *WHAT))
SWEEPS = View("sweeps", "Sweeps", "", "attributes.start_time", ("grid", *WHAT))
STUDIES = View(
    "studies",
    "Preliminary studies",
    f"{PAPER} and params.features = 'selection_3' and params.condition = 'disturbed'"
    " and params.protocol = 'random_folds'",
    "metrics.`test_score`",
    ("classifier", *(f"classifier.{size}" for size in SIZES)),
)
VIEWS = (SCORES, SWEEPS, STUDIES, OTHER_GRIDS)


def state(view: View) -> dict[str, Any]:
    """The state of MLflow's table of runs that shows the view."""
    return {
        "searchFilter": view.filter,
        "orderByKey": view.order_by,
        "orderByAsc": False,
        "selectedColumns": [*(f"params.`{p}`" for p in view.parameters), *(f"metrics.`{m}`" for m in METRICS)],
    }


def encode(state: Mapping[str, Any]) -> str:
    """The state as MLflow writes it: deflated JSON in base64 behind the word ``deflate;``.

    >>> decode(encode({"orderByAsc": False}))
    {'orderByAsc': False}
    """
    return "deflate;" + base64.b64encode(zlib.compress(json.dumps(state).encode())).decode()


def decode(text: str) -> dict[str, Any]:
    """Inverse of :func:`encode`."""
    result: dict[str, Any] = json.loads(zlib.decompress(base64.b64decode(text.removeprefix("deflate;"))))
    return result


def save_views(store: Store) -> None:
    """Put the views into the experiment, where the page also lists them under Views."""
    for view in VIEWS:
        now = int(1000 * time.time())
        value = {"name": view.name, "createdAt": now, "updatedAt": now, "state": encode(state(view))}
        store.client.set_experiment_tag(store.experiment_id, f"mlflow.sharedViewState.{view.key}", json.dumps(value))


def link(store: Store, server: str, view: View = SCORES) -> str:
    """Address of the view on an MLflow server such as ``http://127.0.0.1:5050``."""
    return f"{_runs(server, store.experiment_id)}&viewStateShareKey={view.key}"


def others(store: Store, server: str) -> dict[str, str]:
    """Addresses of the runs of all other experiments that have some, by name, such as those of closing the loop."""
    found = store.client.search_experiments(order_by=["name"])
    beside = {each.name: each.experiment_id for each in found if each.experiment_id != store.experiment_id}
    return {name: _runs(server, number) for name, number in beside.items() if _has_runs(store, number)}


def _has_runs(store: Store, experiment: str, those: str = "") -> bool:
    return bool(store.client.search_runs([experiment], those, max_results=1))


def _runs(server: str, experiment: str) -> str:
    return f"{server}/#/experiments/{experiment}/runs?workflowType=machine_learning"


def serve(store: Store, host: str, port: int) -> None:
    """Run MLflow's page for a local store until it is interrupted; with a server, only print the links.

    Views that would show no run are left out.
    """
    save_views(store)
    server = f"http://{host}:{port}" if store.folder else store.uri
    shown = [view for view in VIEWS if _has_runs(store, store.experiment_id, view.filter)]
    links = {view.name: link(store, server, view) for view in shown}
    links |= {f"Experiment {name}": address for name, address in others(store, server).items()}
    for name, address in links.items():
        print(f"{name}: {address}", flush=True)
    if not links:
        print(f"No runs yet, 'make paper' and 'make loop' keep theirs here: {server}", flush=True)
    if store.folder:
        with until_stopped():
            run_mlflow(store.uri, host, port, "--workers", "1")
