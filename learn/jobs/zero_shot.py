"""The job of a method without adaptation: train on every split's training rows, judge its test rows."""

import itertools
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pandas as pd

from learn.inputs.inputs import LearningSet
from learn.jobs import settings
from learn.protocols.levels import Episode, NewGears, zero_shot_split
from learn.protocols.splits import Split


def results(
    config: Mapping[str, Any], data: LearningSet
) -> tuple[dict[str, float], dict[str, bytes], dict[str, pd.DataFrame]]:
    """Metrics, pictures (PNG) and tables of a resolved configuration of ``conf/train.yaml``."""
    from learn.evaluation.confusion import picture
    from learn.evaluation.evaluate import Evaluation, evaluate
    from learn.methods.choosing import CONFIGURED, Choice, Options, choose, trial_metrics
    from swgsim.common.style import png

    protocol = settings.protocol(config["protocol"])
    make = settings.classifier(config["classifier"], data.layout)
    y, gears = data.table["label"].astype(str).to_numpy(), data.table["gear"].to_numpy()

    def evaluated(splits: Sequence[Split], options: Iterable[Options]) -> Evaluation:
        """With options of its own for every split."""
        of_split = iter(options)
        return evaluate(data.features, y, splits, lambda: make(**next(of_split)), gears)

    splits = list(protocol.split(data.features, data.table))
    choices = [CONFIGURED] * len(splits)
    if isinstance(protocol, NewGears) and protocol.development:
        trials = settings.trials(config["classifier"])

        def chosen(episode: Episode) -> Choice:
            development = [zero_shot_split(each) for each in protocol.development_episodes(data.table, episode)]
            if not development:
                return CONFIGURED
            return choose(trials, lambda tried: evaluated(development, itertools.repeat(tried)).mean_test_score)

        choices = [chosen(episode) for episode in protocol.episodes(data.table)]
    evaluation = evaluated(splits, [choice.options for choice in choices])

    metrics = evaluation.metrics() | trial_metrics(choices)
    title = "{study}: {classifier[name]}, {features[name]}".format(**config)
    predictions = (
        {"tables/predictions.parquet": evaluation.predictions(data.table)} if isinstance(protocol, NewGears) else {}
    )
    return metrics, {"figures/confusion.png": png(picture(evaluation, title))}, predictions
