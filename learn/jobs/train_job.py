"""One job: trains and tests a method on the inputs of a data set under a protocol; keeps it as one MLflow run."""

import logging
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits
from tqdm import tqdm

from learn import tracking
from learn.inputs.inputs import LearningSet, Representation, gear_by_gear, with_foreign_gears, with_training_gears
from learn.inputs.joint_rows import joint_rows
from learn.jobs import few_shot, identity, settings, zero_shot
from swgsim.common.checks import require_known
from swgsim.storage import storage

log = logging.getLogger(__name__)

BLOCK = 1024  # recordings in memory at a time
LARGE = 100_000  # number of recordings from which on the inputs are in a file
ROWS = ("recording", "unit")
# Classifiers of signals over the angle, and of a recording with its references.
OF_RECORDINGS = ("cnn", "resnet", "minirocket", "twin", "fast_twin")
# Options that name a further data set, and how its gears join.
JOINING = {"target": with_foreign_gears, "training": with_training_gears}


@lru_cache(maxsize=4)
def learning_set_of(path: Path, digest: str, representation: Representation) -> LearningSet:
    """The inputs of a data set; computed once per process while the file's digest stays the same."""
    recordings, blocks = storage.shape(path)[0], storage.blocks(path, BLOCK)
    if recordings < LARGE:
        return representation.learning_set(blocks)
    with tqdm(total=recordings, desc="inputs", unit=" recordings") as bar:
        return gear_by_gear(blocks, representation, path.parent, bar.update)


def run(config: Mapping[str, Any]) -> dict[str, float]:
    """Do the job of a resolved configuration of ``conf/train.yaml``, unless it has a finished run.

    Returns
    -------
    dict
        The metrics: scores [%] and the time to fit [s], as :meth:`learn.evaluation.Evaluation.metrics` and
        :meth:`Adapted.metrics` name them; and ``trial/1`` and so on, the scores of the options that were
        tried on development gears.

    Raises
    ------
    ValueError
        If a choice is unknown, with the list of choices, or the data set does not exist, with the command to make it.
    """
    chosen = {group: config[group]["name"] for group in ("grid", "condition")}  # their content is in the data set
    config = {**config, **chosen, "classifier": settings.on_device(config["classifier"])}
    representation = settings.representation(config["features"])
    require_known("rows", [config["rows"]], ROWS)
    if config["rows"] == "unit" and config["classifier"]["name"] in OF_RECORDINGS:
        raise ValueError(f"classifier={config['classifier']['name']} judges recordings, not units: take rows=recording")
    settings.protocol(config["protocol"])
    settings.classifier(config["classifier"])
    if config["adaptation"]["name"] != "none":
        settings.adaptation(config["adaptation"])
    joining = {name: join for name, join in JOINING.items() if config[name]}
    paths = [settings.data_set(config), *(_further(config, name) for name in joining)]
    digests = [storage.digest(path) for path in paths]
    digest = "+".join(digests)
    store = settings.store(config["tracking"])

    parameters = identity.flat(identity.decisive(config))
    name = run_name(config, parameters)
    key = identity.job_key(config, digest)
    done = tracking.finished_metrics(store, key)
    if done:
        log.info("%s: done before, test score %.2f %%", name, done["test_score"])
        return done

    import sklearn  # noqa: F401 - a limit of threads holds for libraries that are loaded

    tags = {"data_digest": digest, "code_version": identity.code_version()}
    # One thread per job: jobs run in parallel, and their threads would wait for each other.
    with threadpool_limits(1), tracking.job_run(store, name, key, parameters, config, tags) as record:
        data, *further = [learning_set_of(*each, representation) for each in zip(paths, digests, strict=True)]
        for join, gears in zip(joining.values(), further, strict=True):
            data = join(data, gears)
        if config["rows"] == "unit":
            data = joint_rows(data)
        judge = zero_shot if config["adaptation"]["name"] == "none" else few_shot
        metrics, pictures, tables = judge.results(config, data)
        record.record(metrics, pictures, tables)
    log.info("%s: test score %.2f %%", name, metrics["test_score"])
    return metrics


def _further(config: Mapping[str, Any], name: str) -> Path:
    """The data set that an option of :data:`JOINING` names as ``<grid>-<condition>``."""
    grid, _, condition = config[name].rpartition("-")
    return settings.data_set({**config, "grid": grid, "condition": condition})


def run_name(config: Mapping[str, Any], parameters: Mapping[str, Any]) -> str:
    """Name of a job's run: protocol, classifier and features first, which MLflow's page must not cut off."""
    groups = ["protocol", "classifier", "features", "rows", "adaptation", "study"]
    for group, usual in (("adaptation", "none"), ("rows", "recording")):
        if parameters[group] == usual:
            groups.remove(group)
    unnamed = ("name", "seed", "trials", *identity.WHEREABOUTS)
    classifier = {k: v for k, v in config["classifier"].items() if k not in unnamed}
    options = [f"{k}={v}" for k, v in classifier.items() if not isinstance(v, Mapping)]
    return " ".join([*(str(parameters[group]) for group in groups), *options])
