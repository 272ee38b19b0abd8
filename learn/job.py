"""One job: a classifier on a feature selection of a data set under a protocol, kept as one MLflow run."""

import logging
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from learn import identity, settings, tracking
from learn.evaluation import evaluate
from learn.features import LearningSet, Selection, learning_set
from swgsim import storage

log = logging.getLogger(__name__)


BLOCK = 1024  # recordings in memory at a time


@lru_cache(maxsize=8)
def learning_set_of(path: Path, digest: str, selection: Selection) -> LearningSet:
    """The features of a data set; computed once per process while the file's digest stays the same."""
    return learning_set(storage.blocks(path, BLOCK), selection)


def run(config: Mapping[str, Any]) -> dict[str, float]:
    """Do the job that a resolved configuration of ``conf/train.yaml`` describes, unless its result is there already.

    Returns
    -------
    dict
        The metrics: scores [%] and the time to fit [s], as :meth:`learn.evaluation.Evaluation.metrics` names them.

    Raises
    ------
    ValueError
        If a choice is unknown, with the list of choices, or the data set does not exist, with the command to make it.
    """
    from learn.confusion import picture

    chosen = {group: config[group]["name"] for group in ("grid", "condition")}  # what is in them, the data set holds
    config = {**config, **chosen}
    selection = settings.selection(config["features"])
    protocol = settings.protocol(config["protocol"])
    method = settings.classifier(config["classifier"])
    path = settings.data_set(config)
    digest = storage.digest(path)
    store = settings.store(config["tracking"])

    parameters = identity.flat(identity.decisive(config))
    options = [f"{key}={value}" for key, value in config["classifier"].items() if key not in ("name", "seed")]
    name = " ".join(["{study} {classifier} {features} {protocol}".format(**parameters), *options])
    key = identity.job_key(config, digest)
    done = tracking.finished_metrics(store, key)
    if done:
        log.info("%s: done before, test score %.2f %%", name, done["test_score"])
        return done

    tags = {"data_digest": digest, "code_version": identity.code_version()}
    # One thread to a job: jobs run side by side, and threads of several would wait for each other.
    with threadpool_limits(1), tracking.job_run(store, name, key, parameters, config, tags) as record:
        data = learning_set_of(path, digest, selection)
        splits = protocol.split(data.features, data.table)
        evaluation = evaluate(data.features, data.table["label"].astype(str).to_numpy(), splits, method)
        metrics = evaluation.metrics()
        record.record(metrics, {"figures/confusion.png": picture(evaluation, name)})
    log.info("%s: test score %.2f %% in %.1f s", name, metrics["test_score"], metrics["fit_seconds"])
    return metrics
