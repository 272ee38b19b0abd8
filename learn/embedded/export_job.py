"""The export that ``conf/export.yaml`` describes: train or read a classifier, write it, compare both."""

import json
import logging
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from learn.embedded import gateway
from learn.embedded.export import NUMBERS, export_c, free
from learn.embedded.fold import of_gears
from learn.embedded.front import front
from learn.embedded.machines import HOST, missing
from learn.embedded.proof import FAITHFUL, Agreement, agreement, decisions_of
from learn.evaluation import models
from learn.inputs.inputs import LearningSet
from learn.jobs import identity, settings
from learn.jobs.train_job import learning_set_of
from swgsim.common.checks import require_known
from swgsim.storage import storage

log = logging.getLogger(__name__)

TARGETS = ("c", "onnx")


def run(config: Mapping[str, Any]) -> None:
    """Export as a resolved configuration of ``conf/export.yaml`` says.

    Raises
    ------
    ValueError
        If a choice is unknown, the gear is not in the data set, the model has another number of inputs, or the folder
        holds other files.
    """
    require_known("target", [config["target"]], TARGETS)
    require_known("numbers", [config["numbers"]], NUMBERS)
    representation = settings.representation(config["features"])
    out = Path(config["out"])
    if config["target"] == "c":
        front(representation)
        free(out)
    chosen = {group: config[group]["name"] for group in ("grid", "condition")}
    path = settings.data_set({**config, **chosen})
    gear = int(config["exported_gear"])
    recordings = of_gears(path, [gear])
    data = learning_set_of(path, storage.digest(path), representation)
    others = data.table["gear"].to_numpy() != gear
    model = _read(Path(config["model"]), data) if config["model"] else _trained(config, data, others)
    inputs = np.asarray(data.features[np.flatnonzero(~others)])
    if config["target"] == "onnx":
        gateway.write(model, out / "model.onnx")
        _compared(out / "model.onnx", gateway.check(out / "model.onnx", model, inputs))
        return
    kept = {"numbers": config["numbers"], "saturation": config["saturation"]}
    export_c(model, representation, recordings.references, out, **kept)
    if not missing(HOST):
        decisions = decisions_of(out, HOST, recordings.samples)
        _compared(out, agreement(decisions, model.predict_proba(inputs)))
    else:
        log.warning("%s: not compared with its original, because gcc is missing: 'apt-get install gcc'", out)


def _compared(path: Path, found: Agreement) -> None:
    """Log how an export agrees with its original; a poor agreement is a warning."""
    log.log(logging.INFO if found.share >= FAITHFUL else logging.WARNING, "%s: %s", path, found)


def _trained(config: Mapping[str, Any], data: LearningSet, others: np.ndarray) -> Any:
    """The classifier trained on all gears but the exported one, or kept from before."""
    rows, label = np.asarray(data.features[np.flatnonzero(others)]), data.table["label"].astype(str).to_numpy()
    description = json.dumps(
        [settings.on_device(config["classifier"]), config["features"], identity.code_version()], sort_keys=True
    )
    make = settings.classifier(config["classifier"], data.layout)
    return models.trained(
        Path(config["models"]), description, make(), rows, label[others], data.table["gear"].to_numpy()[others]
    )


def _read(path: Path, data: LearningSet) -> Any:
    if not path.is_file():
        raise ValueError(f"no model {path}: give a file of the folder models, or model=null to train one")
    model = models.load(path)
    columns = getattr(model, "n_features_in_", None) or len(model.network_.centre)
    if columns != len(data.names):
        raise ValueError(
            f"{path} was trained on {columns} inputs, these features have {len(data.names)}: "
            "give the features that it was trained on"
        )
    return model
