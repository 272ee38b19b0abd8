"""All methods receive the same rows of a target gear, and none of the judged rows."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from fabricated import recordings
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf
from sklearn.base import clone
from sklearn.ensemble import RandomForestClassifier

from learn.adaptation.adapting import adapt_and_judge
from learn.adaptation.fine_tuning import FineTuning
from learn.adaptation.retraining import FromScratch
from learn.adaptation.rezero import Rezero
from learn.adaptation.transfer import Adaptation
from learn.inputs.harmonics import Harmonics
from learn.inputs.inputs import LearningSet
from learn.jobs import few_shot, settings, zero_shot
from learn.methods.neural import neural_perceptron
from learn.protocols.levels import NewGears
from swgsim.common.seeds import seed_hash

CONF = Path(__file__).parents[2] / "conf"
FILES = sorted(path for path in (CONF / "adaptation").glob("*.yaml") if path.stem != "none")
PROTOCOL = NewGears(folds=2, development=0, labelled=2, unlabelled=1, kept_out=1)
FOREST = RandomForestClassifier(10, random_state=0)


@pytest.fixture(scope="module")
def data():
    return Harmonics("harmonics", 6).learning_set([recordings(gears=4, disturbance=0.002)])


@pytest.fixture(scope="module")
def numbered(data):
    """Features that give the number of the row."""
    rows = np.arange(len(data.table), dtype=float)
    return LearningSet(np.column_stack([rows, -rows]), data.table, ("row", "minus row"))


class Spy:
    """Records its arguments and predicts healthy."""

    classes_ = np.array(["healthy"])

    def __init__(self):
        self.given, self.asked = [], []

    def adapt(self, source, kept, shots, unlabelled, seed):
        self.given.append((kept, shots, unlabelled, seed))
        return self

    def predict(self, X):
        self.asked.append(X[:, 0].astype(int))
        return np.repeat("healthy", len(X))

    def predict_proba(self, X):
        return np.ones((len(X), 1))


def spied(data, shots, draws=3):
    spy, source = Spy(), Spy()
    adapted = adapt_and_judge(data, PROTOCOL.episodes(data.table), lambda X, y, gears: source, spy, shots, draws)
    return spy, adapted


def targets(table):
    return [(episode, target) for episode in PROTOCOL.episodes(table) for target in episode.targets]


def rows_of(X):
    return X[:, 0].astype(int)


def test_methods_receive_the_shots_of_their_draw_or_the_unlabelled_rows_and_never_judged_ones(numbered):
    names = numbered.table["label"].astype(str).to_numpy()
    for numbers in ([1, 2], [0]):
        spy, _ = spied(numbered, numbers)
        episodes = list(PROTOCOL.episodes(numbered.table))
        wanted = [(e, t, k, d) for e in episodes for k in numbers for d in range(3 if k else 1) for t in e.targets]
        assert len(spy.given) == len(wanted)
        for (kept, shots, unlabelled, _), (episode, target, number, draw) in zip(spy.given, wanted, strict=True):
            assert np.array_equal(rows_of(kept.X), episode.source)
            assert np.array_equal(rows_of(shots.X), target.shots(numbered.table, number, draw))
            assert np.array_equal(shots.y, names[rows_of(shots.X)])
            assert np.array_equal(kept.y, names[rows_of(kept.X)])
            assert np.array_equal(rows_of(unlabelled), [] if number else target.unlabelled)
            given = np.concatenate([rows_of(each) for each in (kept.X, shots.X, unlabelled)])
            assert not np.intersect1d(given, np.append(target.judged, episode.kept_out)).size
        assert len({seed for *_, seed in spy.given}) == len(wanted)
        asked = set(np.concatenate(spy.asked))
        assert asked == {r for e, t in targets(numbered.table) for r in (*t.judged, *e.kept_out)}


def test_two_representations_give_the_same_rows_and_seeds(numbered):
    other = replace(numbered, features=np.column_stack([numbered.features, numbered.features**2]), names=tuple("abcd"))
    (one, _), (two, _) = spied(numbered, [0, 1], draws=2), spied(other, [0, 1], draws=2)
    for (kept, shots, unlabelled, seed), (kept2, shots2, unlabelled2, seed2) in zip(one.given, two.given, strict=True):
        assert seed == seed2
        for X, X2 in ((kept.X, kept2.X), (shots.X, shots2.X), (unlabelled, unlabelled2)):
            assert np.array_equal(rows_of(X), rows_of(X2))


def test_errors_are_counted_by_specimen_and_by_gear(numbered):
    _, adapted = spied(numbered, shots=[0, 1])
    truth = numbered.table["label"].astype(str).to_numpy()
    judged = {t.gear: t.judged for _, t in targets(numbered.table)}
    assert len(adapted.specimens) == 2 * sum(len(rows) for rows in judged.values()) / 4  # operating points
    assert (adapted.specimens["error"] == np.where(adapted.specimens["label"] == "healthy", 0.0, 100.0)).all()
    # A spy says the same at all operating points.
    assert (adapted.specimens["unit"] == adapted.specimens["error"]).all()
    expected = {gear: 100 * np.mean(truth[rows] != "healthy") for gear, rows in judged.items()}
    np.testing.assert_allclose(adapted.gears["error"], adapted.gears["gear"].map(expected))
    assert adapted.gears[["gear", "shots"]].apply(tuple, axis=1).is_unique
    metrics = adapted.metrics()
    each = {f"{name}/{number}_shots" for name in ("error", "unadapted", "forgotten") for number in (0, 1)}
    assert set(metrics) == {"test_score", *each}
    assert metrics["test_score"] == pytest.approx(100 - adapted.mean_error(), abs=1e-3)
    assert metrics["forgotten/0_shots"] == 0


def test_from_scratch_with_all_shots_is_training_on_the_labelled_rows(data):
    def source_model(X, y, gears=None):
        return clone(FOREST).fit(X, y)

    adapted = adapt_and_judge(data, PROTOCOL.episodes(data.table), source_model, FromScratch(), [2], draws=2)
    y = data.table["label"].astype(str).to_numpy()
    for episode, target in targets(data.table):
        wrong, forgotten = [], []
        before = source_model(data.features[episode.source], y[episode.source])
        for draw in range(2):
            seed = seed_hash("adaptation", target.gear, 2, draw) % 2**31
            direct = clone(FOREST).set_params(random_state=seed).fit(data.features[target.labelled], y[target.labelled])
            wrong.append(direct.predict(data.features[target.judged]) != y[target.judged])
            kept_out, truth = data.features[episode.kept_out], y[episode.kept_out]
            forgotten.append(
                100 * (np.mean(before.predict(kept_out) == truth) - np.mean(direct.predict(kept_out) == truth))
            )
        (row,) = adapted.gears[adapted.gears["gear"] == target.gear].itertuples()
        assert row.error == pytest.approx(100 * np.mean(wrong))
        assert row.forgotten == pytest.approx(np.mean(forgotten))
        facts = data.table.iloc[target.judged].assign(label=y[target.judged], error=100 * np.mean(wrong, axis=0))
        expected = facts.groupby(["label", "variant"])["error"].mean()
        found = adapted.specimens[adapted.specimens["gear"] == target.gear].set_index(["label", "variant"])["error"]
        pd.testing.assert_series_equal(found, expected)
    assert adapted.gears["error"].max() > 0  # else the comparison says little


def test_the_source_model_itself_forgets_nothing_and_one_that_is_tuned_does(data):
    def source_model(X, y, gears=None):
        return neural_perceptron(neurons=16, epochs=20, batch=32, device="cpu").fit(X, y)

    first, without = (next(replace(PROTOCOL, kept_out=number).episodes(data.table)) for number in (1, 0))
    still, tuned, unknown = (
        adapt_and_judge(data, [episode], source_model, FineTuning(steps, rate=0.1), [1], draws=1).gears
        for episode, steps in ((first, 0), (first, 20), (without, 0))
    )
    assert (still["forgotten"] == 0).all()
    assert (still["error"] == still["unadapted"]).all()
    assert (tuned["forgotten"] != 0).any()
    assert (tuned["unadapted"] == still["unadapted"]).all()
    assert unknown["forgotten"].isna().all()
    assert unknown["error"].notna().all()


def configuration(path, shots=(1, 2)):
    return yaml.safe_load(path.read_text().replace("${shots}", str(list(shots))).replace("${seed}", "0"))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_adaptation_of_the_configuration_is_built_with_each_of_its_trials(path):
    config = configuration(path)
    assert config["name"] == path.stem
    assert list(config["shots"]) in ([0], [1, 2], [0, 1, 2, 5])
    trials = settings.trials(config)
    made = [settings.adaptation(config)(**trial) for trial in trials]
    assert all(isinstance(each, Adaptation | Rezero) for each in made)
    assert len(set(map(repr, made))) == len(trials)
    assert len(trials) in (1, 2)  # the same number for every method that has something to choose


def composed(models, *overrides):
    small = ["protocol=new_gears", "protocol.folds=2", "protocol.development=2", "protocol.labelled=2"]
    small += ["protocol.unlabelled=1", "protocol.kept_out=1", "shots=[1,2]", "draws=2", "features=harmonics"]
    small += ["classifier=rf", "classifier.trees=5", f"models={models}"]
    with initialize_config_dir(str(CONF), version_base="1.3"):
        return OmegaConf.to_container(compose("train", [*small, *overrides]), resolve=True)


def test_the_results_of_a_job_are_errors_by_specimen_and_gear_and_other_jobs_use_its_source_models(data, tmp_path):
    trials = "adaptation.trials=[{strength: 1.0}, {strength: 30.0}]"
    metrics, _, tables = few_shot.results(composed(tmp_path, "adaptation=leaf_relabelling", trials), data)
    assert {"test_score", "error/1_shots", "error/2_shots", "forgotten/1_shots", "trial/1", "trial/2"} <= set(metrics)
    gears, specimens = tables["tables/gears.parquet"], tables["tables/specimens.parquet"]
    assert gears[["gear", "shots"]].to_numpy().tolist() == [[g, k] for g in (1, 2) for k in (1, 2)]
    assert 100 - gears["error"].mean() == pytest.approx(metrics["test_score"], abs=1e-3)
    assert list(specimens.columns) == ["gear", "label", "variant", "shots", "error", "unit", "unadapted"]
    assert len(specimens) == 2 * 2 * 6 * 3  # gears, numbers of shots, classes, judged variants
    np.testing.assert_allclose(
        specimens.groupby(["gear", "shots"])["error"].mean(), gears.set_index(["gear", "shots"])["error"]
    )

    before = {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()}
    other = few_shot.results(composed(tmp_path, "adaptation=coral", "adaptation.trials=null"), data)[0]
    assert {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()} == before
    assert len(before) == 2 + 2  # folds of the judged gears and of the development gears
    assert other["unadapted/0_shots"] == metrics["unadapted/1_shots"]
    assert "error/1_shots" not in other


def test_a_job_without_adaptation_is_judged_on_the_same_rows(data, tmp_path):
    config = composed(tmp_path)
    predictions = zero_shot.results(config, data)[2]["tables/predictions.parquet"]
    protocol = settings.protocol(config["protocol"])
    judged = [row for e in protocol.episodes(data.table) for t in e.targets for row in t.judged]
    assert sorted(predictions["row"]) == sorted(judged)


def test_a_protocol_that_leaves_no_gear_is_refused(data):
    config = {"protocol": {"name": "random_folds", "folds": 4}}
    with pytest.raises(ValueError, match="protocol random_folds leaves no gear to adapt to: take new_gears, or adapt"):
        few_shot.results(config, data)
