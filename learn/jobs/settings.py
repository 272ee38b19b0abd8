"""Makes objects from the configuration; the error of an unknown choice lists the choices."""

import inspect
import shlex
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from learn.inputs.features import Selection
from learn.inputs.harmonics import Harmonics
from learn.inputs.inputs import NO_SIGNAL, Layout, Representation
from learn.inputs.lines import ResidualLines
from learn.inputs.referenced import Referenced
from learn.inputs.signals import CHANNELS, Signals
from learn.methods import classical, contract, neural, strong
from learn.methods.fast_twin import FastTwin
from learn.methods.rocket import MiniRocket
from learn.methods.twin import TwinClassifier
from learn.protocols.harder_splits import LeaveOperatingPointOut, LeaveSeverityOut
from learn.protocols.levels import NewGears
from learn.protocols.splits import GroupedFolds, LeaveOneGearOut, RandomFolds, Splitting
from learn.tracking import Store, local_store, server_store

if TYPE_CHECKING:
    from learn.adaptation.rezero import Rezero
    from learn.adaptation.transfer import Adaptation

NO_OPTIONS = ("name", "trials", "shots", "defaults")  # entries of a file in conf that are no arguments of its object

T = TypeVar("T")
Config = Mapping[str, Any]

REPRESENTATIONS: Mapping[str, Callable[..., Representation]] = {
    **dict.fromkeys(CHANNELS, Signals),
    "lines": ResidualLines,
    "harmonics": Harmonics,
    "referenced": Referenced,
}
CLASSIFIERS: Mapping[str, Callable[..., classical.Classifier]] = {
    "mlp": classical.multi_layer_perceptron,
    "svm": classical.support_vector_machine,
    "rf": classical.random_forest,
    "knn": classical.nearest_neighbours,
    "nb": classical.naive_bayes,
    "logistic_regression": strong.logistic_regression,
    "gradient_boosting": strong.gradient_boosting,
    "extra_trees": strong.extra_trees,
    "minirocket": MiniRocket,
    "perceptron": neural.neural_perceptron,
    "cnn": neural.convolutional_network,
    "resnet": neural.residual_network,
    "set_network": neural.set_network,
    "twin": TwinClassifier,
    "fast_twin": FastTwin,
}
PROTOCOLS: Mapping[str, Callable[..., Splitting]] = {
    "random_folds": RandomFolds,
    "grouped_folds": GroupedFolds,
    "leave_one_gear_out": LeaveOneGearOut,
    "new_gears": NewGears,
    "leave_severity_out": LeaveSeverityOut,
    "leave_operating_point_out": LeaveOperatingPointOut,
}
STORES: Mapping[str, Callable[..., Store]] = {"local": local_store, "server": server_store}


def representation(config: Config) -> Representation:
    """The inputs of methods, of ``conf/features``; an unknown name is a selection of the user's own."""
    name = str(config.get("name"))
    return _configured(f"features {name}", REPRESENTATIONS.get(name, Selection), config)()


def protocol(config: Config) -> Splitting:
    """The protocol of ``conf/protocol``."""
    return _chosen("protocol", PROTOCOLS, config)()


def classifier(config: Config, layout: Layout | None = None) -> Callable[..., classical.Classifier]:
    """A maker of untrained classifiers of ``conf/classifier``; it takes options in place of those configured.

    Parameters
    ----------
    config : mapping
        Its ``name`` is a built-in classifier, or the import path ``module:Class`` of another one.
    layout : Layout, optional
        Where in a row the signal is, for classifiers that use it. With it, a class that is given by its import path
        is tried on a few made-up rows.

    Raises
    ------
    ValueError
        If there is no such classifier or option, or a class does not keep :class:`learn.methods.Classifier`.
    """
    name = str(config.get("name"))
    own = contract.is_import_path(name)
    make = _chosen("classifier", {name: contract.class_of(name)} if own else CLASSIFIERS, config)
    if "channels" in inspect.signature(make).parameters:
        make = partial(make, **(layout or NO_SIGNAL)._asdict())
    if own and layout is not None:
        contract.require_contract(name, make, layout.columns + 8)
    return make


def on_device(config: Config) -> dict[str, Any]:
    """The configuration of a classifier with the device that ``auto`` means on this machine.

    Results of a processor and of an accelerator differ in the last digits, so a job must name where it ran.
    """
    if config.get("device") != "auto":
        return dict(config)
    from learn.methods.training import choose_device  # with torch, which takes seconds

    return {**config, "device": choose_device("auto").type}


def adaptation(config: Config) -> Callable[..., "Adaptation | Rezero"]:
    """Makes the adaptation of ``conf/adaptation``; its arguments replace configured options."""
    from learn.adaptation.adaptations import ADAPTATIONS  # with torch, which takes seconds

    return _chosen("adaptation", ADAPTATIONS, config)


def trials(config: Config) -> list[dict[str, Any]]:
    """The options to try on development gears, ``trials`` of a method's file; without trials one empty entry."""
    return [dict(options) for options in config.get("trials") or [{}]]


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
    folder = Path(config["data"]).resolve()
    path = folder / f"{config['grid']}-{config['condition']}.h5"
    if not path.is_file():
        existing = ", ".join(sorted(p.stem for p in folder.glob("*-*.h5"))) or "none"
        raise ValueError(
            f"no data set {path}; data sets in {folder}: {existing}. Give another folder with data=..., or make it: "
            f"swg generate grid={config['grid']} condition={config['condition']}{_elsewhere(config)}"
        )
    return Path(config["data"]) / path.name


def train_command(config: Config) -> str:
    """The command that makes runs on the data sets and in the store of a configuration, without its experiment."""
    tracking = config["tracking"]
    place = f" tracking=server tracking.uri={tracking['uri']}" if tracking["name"] == "server" else ""
    if tracking["name"] == "local" and tracking["folder"] != "mlruns":
        place = f" tracking.folder={shlex.quote(str(tracking['folder']))}"
    return f"swg train grid={config['grid']['name']}{_elsewhere(config)}{place}"


def _elsewhere(config: Config) -> str:
    """The option that names the folder of the data sets, if it is not the default one."""
    return f" data={shlex.quote(str(config['data']))}" if str(config["data"]) != "data" else ""


def _chosen(kind: str, choices: Mapping[str, Callable[..., T]], config: Config) -> Callable[..., T]:
    name = str(config.get("name"))
    if name not in choices:
        own = ", or give the import path module:Class" if kind == "classifier" else ""
        raise ValueError(f"unknown {kind} {name!r}; choose from {', '.join(choices)}{own}")
    options = {key: value for key, value in config.items() if key not in NO_OPTIONS}
    return _configured(f"{kind} {name}", choices[name], options)


def _configured(kind: str, factory: Callable[..., T], options: Config) -> Callable[..., T]:
    known = inspect.signature(factory).parameters
    for option in options:
        if option not in known:
            raise ValueError(f"unknown option {option!r} of {kind}; choose from {', '.join(known) or 'none'}")
    return partial(factory, **options)
