"""The job of a method without adaptation: train on every split's training rows, judge its test rows."""

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from learn.inputs.inputs import LearningSet
from learn.jobs import settings
from learn.protocols.levels import NewGears

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def results(
    config: Mapping[str, Any], data: LearningSet
) -> tuple[dict[str, float], dict[str, "Figure"], dict[str, pd.DataFrame]]:
    """Metrics, figures and tables of a resolved configuration of ``conf/train.yaml``."""
    from learn.evaluation.confusion import picture
    from learn.evaluation.evaluate import Evaluation, evaluate
    from learn.methods.choosing import choose, trial_metrics

    protocol = settings.protocol(config["protocol"])
    make = settings.classifier(config["classifier"], data.layout)
    y, gears = data.table["label"].astype(str).to_numpy(), data.table["gear"].to_numpy()

    def evaluated(splits: Any, options: Mapping[str, Any]) -> Evaluation:
        return evaluate(data.features, y, splits, partial(make, **options), gears)

    options: Mapping[str, Any] = {}
    scores: list[float] = []
    if isinstance(protocol, NewGears) and protocol.development:
        splits = list(protocol.development_splits(data.table))
        trials = settings.trials(config["classifier"])
        options, scores = choose(
            trials, lambda tried: float(np.mean([s.test for s in evaluated(splits, tried).scores]))
        )
    evaluation = evaluated(protocol.split(data.features, data.table), options)

    metrics = evaluation.metrics() | trial_metrics(scores)
    title = "{study}: {classifier[name]}, {features[name]}".format(**config)
    predictions = (
        {"tables/predictions.parquet": evaluation.predictions(data.table)} if isinstance(protocol, NewGears) else {}
    )
    return metrics, {"figures/confusion.png": picture(evaluation, title)}, predictions
