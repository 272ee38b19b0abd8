"""Hyper-parameters are chosen on development gears, and gears that are judged have no say."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from fabricated import recordings

import learn.adaptation.adapting
from learn.inputs.harmonics import Harmonics
from learn.jobs import few_shot, zero_shot
from learn.methods.choosing import choose

TRIALS = [{"strength": 0.1}, {"strength": 3.0}, {"strength": 1000.0}]


def test_the_first_of_the_best_is_chosen_and_a_single_trial_needs_no_score():
    trials = [{"a": 1}, {"a": 3}, {"a": 2}, {"a": 3}]
    options, number, scores = choose(trials, lambda options: float(options["a"]))
    assert options is trials[1]
    assert number == 1
    assert scores == [1.0, 3.0, 2.0, 3.0]
    assert choose([{"a": 1}], lambda options: pytest.fail("scored")) == ({"a": 1}, 0, ())


@pytest.fixture(scope="module")
def data():
    """Five gears; three of them, 3 to 5, are for development."""
    return Harmonics("harmonics", 6).learning_set([recordings(gears=5, disturbance=0.05)])


def configuration(folder, **adaptation):
    method = {"name": "leaf_relabelling", "shots": [1, 2], "trials": TRIALS, **adaptation}
    protocol = {"name": "new_gears", "folds": 2, "development": 3, "labelled": 3, "unlabelled": 1, "kept_out": 1}
    classifier = {"name": "rf", "trees": 5, "depth": 3, "trials": [{"depth": 1}, {"depth": 3}]}
    return {
        "study": "test", "features": {"name": "harmonics"}, "protocol": protocol, "classifier": classifier,
        "adaptation": method, "models": str(folder), "draws": 1,
    }  # fmt: skip


def poisoned(data, gears):
    """The data with every class of some gears called by the name of another one."""
    label = data.table["label"]
    names = label.cat.categories
    other = label.map(dict(zip(names, np.roll(names, 1), strict=True)))
    mixed = label.astype(str).where(~data.table["gear"].isin(gears), other.astype(str))
    return replace(data, table=data.table.assign(label=pd.Categorical(mixed, categories=names)))


def trials_of(metrics):
    return {name: value for name, value in metrics.items() if name.startswith("trial/")}


def judging(config, gears):
    """The same job with the fold alone that judges the first gears; the gears that follow are its sources."""
    return {**config, "protocol": {**config["protocol"], "judged": gears}}


@pytest.mark.parametrize("kind", [few_shot, zero_shot], ids=["with adaptation", "without adaptation"])
def test_trials_depend_on_labels_of_development_gears_and_not_of_the_gears_that_the_fold_judges(kind, data, tmp_path):
    config = judging(configuration(tmp_path), 1)
    clean, judged, development = (
        kind.results(config, each)[0] for each in (data, poisoned(data, [1]), poisoned(data, [5]))
    )
    assert len(trials_of(clean)) == (3 if kind is few_shot else 2)
    assert trials_of(judged) == trials_of(clean)
    assert judged["test_score"] != clean["test_score"]
    assert trials_of(development) != trials_of(clean)


def spied(config, data, monkeypatch):
    """The options, numbers of shots, draws and target gears of every call that adapts."""
    calls = []
    judge = learn.adaptation.adapting.adapt_and_judge

    def record(data, episodes, source_model, adaptation, shots, draws):
        episodes = list(episodes)
        gears = {target.gear for episode in episodes for target in episode.targets}
        calls.append((adaptation.strength, list(shots), draws, gears))
        return judge(data, episodes, source_model, adaptation, shots, draws)

    monkeypatch.setattr(learn.adaptation.adapting, "adapt_and_judge", record)
    metrics, figures, tables = few_shot.results(config, data)
    assert set(tables) == {"tables/specimens.parquet", "tables/gears.parquet"}
    assert not figures
    return calls, metrics


def test_options_are_tried_on_development_gears_and_the_best_are_judged(data, tmp_path, monkeypatch):
    # A development gear unlike its sources, so that it matters how much the shots count.
    calls, metrics = spied({**configuration(tmp_path), "draws": 2}, poisoned(data, [5]), monkeypatch)
    for fold, of_fold in enumerate((calls[:4], calls[4:]), start=1):
        assert of_fold[:-1] == [(trial["strength"], [2], 1, {3, 4, 5}) for trial in TRIALS]
        assert of_fold[-1] == (TRIALS[int(metrics[f"chosen/{fold}"]) - 1]["strength"], [1, 2], 2, {fold})
    assert len(set(trials_of(metrics).values())) > 1  # else any would do


@pytest.mark.parametrize(("shots", "tried"), [([3, 1], 1), ([3, 2], 2)])
def test_options_are_tried_with_few_shots_or_the_fewest_there_are(shots, tried, data, tmp_path, monkeypatch):
    monkeypatch.setattr(few_shot, "TRIED_SHOTS", 1)
    calls, _ = spied(judging(configuration(tmp_path, shots=shots), 2), data, monkeypatch)
    assert [call[1] for call in calls] == [[tried]] * 3 + [shots]


def test_without_development_gears_the_configured_options_are_taken(data, tmp_path, monkeypatch):
    config = configuration(tmp_path, strength=7.0)
    config["protocol"]["development"] = 0
    calls, metrics = spied(config, data, monkeypatch)
    assert calls == [(7.0, [1, 2], 1, gears) for gears in ({1, 3, 5}, {2, 4})]
    assert not trials_of(metrics)
