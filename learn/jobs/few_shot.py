"""The job of an adaptation: train on every fold's source gears, adapt to each gear left out, judge it."""

import json
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from learn.inputs.inputs import LearningSet
from learn.jobs import identity, settings
from learn.protocols.levels import Episode, NewGears

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from learn.adaptation.adapting import Adapted

TRIED_SHOTS = 5  # most shots with which options are tried on development gears; if all are more, the fewest


def results(
    config: Mapping[str, Any], data: LearningSet
) -> tuple[dict[str, float], dict[str, "Figure"], dict[str, pd.DataFrame]]:
    """Metrics, figures and tables of a resolved configuration of ``conf/train.yaml``.

    Raises
    ------
    ValueError
        If the protocol leaves no gears to adapt to.
    """
    from learn.adaptation.adapting import adapt_and_judge
    from learn.evaluation import models
    from learn.methods.choosing import choose, trial_metrics

    protocol = settings.protocol(config["protocol"])
    if not isinstance(protocol, NewGears):
        raise ValueError(
            f"protocol {config['protocol']['name']} leaves no gear to adapt to: take new_gears, or adaptation=none"
        )
    make, adaptation = settings.classifier(config["classifier"], data.layout), config["adaptation"]
    y, gears = data.table["label"].astype(str).to_numpy(), data.table["gear"].to_numpy()

    def source_model(X: np.ndarray, y: np.ndarray, gears: np.ndarray, **options: Any) -> Any:
        identity_of_source = json.dumps([config["classifier"], options, identity.code_version()], sort_keys=True)
        return models.trained(Path(config["models"]), identity_of_source, make(**options), X, y, gears)

    def source_score(options: Mapping[str, Any]) -> float:
        shares = [
            np.mean(
                source_model(np.asarray(data.features[train]), y[train], gears[train], **options).predict(
                    data.features[test]
                )
                == y[test]
            )
            for _, train, test in protocol.development_splits(data.table)
        ]
        return 100 * float(np.mean(shares))

    # The options of the source model are chosen as without adaptation.
    source_trials = settings.trials(config["classifier"]) if protocol.development else [{}]
    source_options, _ = choose(source_trials, source_score)
    source = partial(source_model, **source_options)

    def adapted(episodes: Iterable[Episode], options: Mapping[str, Any], shots: Sequence[int], draws: int) -> "Adapted":
        return adapt_and_judge(data, episodes, source, settings.adaptation(adaptation)(**options), shots, draws)

    def score(options: Mapping[str, Any]) -> float:
        shots = adaptation["shots"]
        few = max((number for number in shots if number <= TRIED_SHOTS), default=min(shots))
        return 100 - adapted(protocol.development_episodes(data.table), options, [few], draws=1).mean_error()

    trials = settings.trials(adaptation) if protocol.development else [{}]
    options, scores = choose(trials, score)
    judged = adapted(protocol.episodes(data.table), options, adaptation["shots"], config["draws"])
    metrics = judged.metrics() | trial_metrics(scores)
    return metrics, {}, {"tables/specimens.parquet": judged.specimens, "tables/gears.parquet": judged.gears}
