"""Trained models come back from their files unchanged, and harmful files are refused before any of it runs."""

import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from sklearn.ensemble import ExtraTreesClassifier, RandomForestClassifier

from learn.evaluation import models
from learn.methods import neural, strong
from learn.methods.classical import multi_layer_perceptron, nearest_neighbours, support_vector_machine

RNG = np.random.default_rng(0)
Y = np.array(["a", "b", "c"])[np.arange(60) % 3]
X = RNG.standard_normal((60, 16)) + 2 * (np.arange(60) % 3)[:, None]
FOREST = RandomForestClassifier(5, max_depth=3, random_state=0)
NETWORKS = {
    "perceptron": neural.neural_perceptron(neurons=8, epochs=2, device="cpu"),
    "cnn": neural.convolutional_network(channels=1, points=8, width=4, epochs=2, device="cpu"),
}
ESTIMATORS = {
    "forest": FOREST,
    "extra trees": ExtraTreesClassifier(5, random_state=0),
    "boosting": strong.gradient_boosting(rounds=3),
    "logistic regression": strong.logistic_regression(),
    "mlp": multi_layer_perceptron(hidden_layers=1, iterations=5),
    "knn": nearest_neighbours(),
}


@pytest.mark.filterwarnings("ignore:Stochastic Optimizer")
@pytest.mark.parametrize("name", [*ESTIMATORS, *NETWORKS])
def test_a_model_comes_back_with_the_same_probabilities(name, tmp_path):
    model = {**ESTIMATORS, **NETWORKS}[name].fit(X, Y)
    back = models.trained(tmp_path, "identity", model, X, Y)
    assert back is not model
    assert np.array_equal(back.predict_proba(X), model.predict_proba(X))
    assert np.array_equal(back.classes_, model.classes_)
    assert np.array_equal(back.predict(X), model.predict(X))
    (kept,) = tmp_path.iterdir()
    assert kept.suffix == (".pt" if name in NETWORKS else ".skops")
    if name in NETWORKS:
        assert (back.device, models.load(kept).device) == ("cpu", "auto")


def test_a_model_without_probabilities_comes_back_too(tmp_path):
    model = support_vector_machine().fit(X, Y)
    models.save(model, tmp_path / "svm.skops")
    assert np.array_equal(models.load(tmp_path / "svm.skops").predict(X), model.predict(X))


def test_a_model_is_trained_once_for_the_same_rows_and_identity(tmp_path, monkeypatch):
    first = models.trained(tmp_path, "identity", FOREST, X, Y)
    monkeypatch.setattr(models, "fit", lambda *_: pytest.fail("trained again"))
    again = models.trained(tmp_path, "identity", FOREST, X, Y)
    assert np.array_equal(first.predict_proba(X), again.predict_proba(X))
    changed = X.copy()
    changed[3, 2] += 1e-12
    for identity, rows, names in (
        ("another", X, Y),
        ("identity", changed, Y),
        ("identity", X[:-1], Y[:-1]),
        ("identity", X, Y[::-1]),
    ):
        with pytest.raises(pytest.fail.Exception, match="trained again"):
            models.trained(tmp_path, identity, FOREST, rows, names)
    assert len(list(tmp_path.iterdir())) == 1


class Slow(RandomForestClassifier):
    """Takes its time, so that another job comes along meanwhile."""

    fits = 0

    def fit(self, *rows):
        type(self).fits += 1
        time.sleep(0.3)
        return super().fit(*rows)


def test_jobs_that_need_the_same_model_at_once_train_it_once(tmp_path, monkeypatch):
    monkeypatch.setattr(models, "TRUSTED", [*models.TRUSTED, f"{Slow.__module__}.Slow"])
    with ThreadPoolExecutor(4) as jobs:
        made = list(jobs.map(lambda _: models.trained(tmp_path, "identity", Slow(3, random_state=0), X, Y), range(4)))
    assert Slow.fits == 1
    assert all(np.array_equal(made[0].predict_proba(X), each.predict_proba(X)) for each in made)


def test_a_fit_that_fails_leaves_no_file(tmp_path):
    with pytest.raises(ValueError, match="1 class"):
        models.trained(tmp_path, "identity", replace(NETWORKS["perceptron"]), X, np.repeat("a", 60))
    assert not list(tmp_path.iterdir())
