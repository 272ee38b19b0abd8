"""The job of an adaptation: train on every fold's source gears, adapt to each gear left out, judge it."""

import json
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from learn.inputs.inputs import LearningSet
from learn.jobs import identity, settings
from learn.protocols.levels import Episode, NewGears, zero_shot_split

TRIED_SHOTS = 5  # most shots with which options are tried on development gears; if all are more, the fewest


def results(
    config: Mapping[str, Any], data: LearningSet
) -> tuple[dict[str, float], dict[str, bytes], dict[str, pd.DataFrame]]:
    """Metrics, pictures (PNG) and tables of a resolved configuration of ``conf/train.yaml``.

    Raises
    ------
    ValueError
        If the protocol leaves no gears to adapt to.
    """
    from learn.adaptation.adapted import Adapted
    from learn.adaptation.adapting import adapt_and_judge
    from learn.evaluation import models
    from learn.methods.choosing import Choice, Options, choose, trial_metrics

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

    def judge(episode: Episode) -> tuple[Adapted, Choice]:
        """Choose the options for the gears of an episode, and judge them."""
        development = protocol.development_episodes(data.table, episode) if protocol.development else []

        def source_score(options: Options) -> float:
            shares = []
            for _, train, test in map(zero_shot_split, development):
                model = source_model(np.asarray(data.features[train]), y[train], gears[train], **options)
                shares.append(np.mean(model.predict(data.features[test]) == y[test]))
            return 100 * float(np.mean(shares))

        # The options of the source model are chosen as without adaptation.
        source = settings.trials(config["classifier"]) if development else [{}]
        train = partial(source_model, **choose(source, source_score).options)

        def adapted(episodes: list[Episode], options: Options, shots: Sequence[int], draws: int) -> Adapted:
            return adapt_and_judge(data, episodes, train, settings.adaptation(adaptation)(**options), shots, draws)

        def score(options: Options) -> float:
            shots = adaptation["shots"]
            few = max((number for number in shots if number <= TRIED_SHOTS), default=min(shots))
            return 100 - adapted(development, options, [few], draws=1).mean_error()

        choice = choose(settings.trials(adaptation) if development else [{}], score)
        return adapted([episode], choice.options, adaptation["shots"], config["draws"]), choice

    parts, choices = zip(*map(judge, protocol.episodes(data.table)), strict=True)
    judged = Adapted.of(parts)
    metrics = judged.metrics() | trial_metrics(choices)
    return metrics, {}, {"tables/specimens.parquet": judged.specimens, "tables/gears.parquet": judged.gears}
