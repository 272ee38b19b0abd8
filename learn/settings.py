"""From configuration to objects, in one place: an unknown choice is answered with the list of choices."""

import inspect
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from learn import classical
from learn.features import Selection
from learn.splits import GroupedFolds, LeaveOneGearOut, RandomFolds, Splitting
from learn.tracking import Store, local_store, server_store

T = TypeVar("T")
Config = Mapping[str, Any]

CLASSIFIERS: Mapping[str, Callable[..., classical.Classifier]] = {
    "mlp": classical.multi_layer_perceptron,
    "svm": classical.support_vector_machine,
    "rf": classical.random_forest,
    "knn": classical.nearest_neighbours,
    "nb": classical.naive_bayes,
}
PROTOCOLS: Mapping[str, Callable[..., Splitting]] = {
    "random_folds": RandomFolds,
    "grouped_folds": GroupedFolds,
    "leave_one_gear_out": LeaveOneGearOut,
}
STORES: Mapping[str, Callable[..., Store]] = {"local": local_store, "server": server_store}


def selection(config: Config) -> Selection:
    """The feature selection of ``conf/features``."""
    return _configured("features", Selection, config)()


def protocol(config: Config) -> Splitting:
    """The protocol of ``conf/protocol``."""
    return _chosen("protocol", PROTOCOLS, config)()


def classifier(config: Config) -> Callable[[], classical.Classifier]:
    """A maker of untrained classifiers of ``conf/classifier``."""
    return _chosen("classifier", CLASSIFIERS, config)


def store(config: Config) -> Store:
    """The MLflow store of ``conf/tracking``."""
    return _chosen("tracking", STORES, config)()


def data_set(config: Config) -> Path:
    """The data set that ``data``, ``grid`` and ``condition`` name.

    Raises
    ------
    ValueError
        If there is no such file; it names the data sets that exist and the command that makes this one.
    """
    folder = Path(config["data"])
    path = folder / f"{config['grid']}-{config['condition']}.h5"
    if not path.is_file():
        there = ", ".join(sorted(p.stem for p in folder.glob("*-*.h5"))) or "none"
        raise ValueError(
            f"no data set {path}; data sets in {folder}: {there}. Make it with "
            f"'python scripts/generate.py grid={config['grid']} condition={config['condition']}'"
        )
    return path


def _chosen(kind: str, choices: Mapping[str, Callable[..., T]], config: Config) -> Callable[[], T]:
    name = str(config.get("name"))
    if name not in choices:
        raise ValueError(f"unknown {kind} {name!r}; choose from {', '.join(choices)}")
    return _configured(f"{kind} {name}", choices[name], {k: v for k, v in config.items() if k != "name"})


def _configured(kind: str, factory: Callable[..., T], options: Config) -> Callable[[], T]:
    known = inspect.signature(factory).parameters
    for option in options:
        if option not in known:
            raise ValueError(f"unknown option {option!r} of {kind}; choose from {', '.join(known) or 'none'}")
    return partial(factory, **options)
