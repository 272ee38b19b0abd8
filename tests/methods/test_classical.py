"""The five classifiers are those of Table VI and learn what can be learnt."""

import numpy as np
import pytest

from learn.jobs.settings import CLASSIFIERS
from learn.methods import classical

TABLE_6 = ("mlp", "svm", "rf", "knn", "nb")


@pytest.mark.parametrize("name", TABLE_6)
def test_every_classifier_separates_clouds_that_lie_apart(name):
    rng = np.random.default_rng(0)
    labels = np.repeat(["a", "b", "c"], 60)
    features = rng.standard_normal((180, 2)) + np.repeat([[0, 0], [9, 0], [0, 9]], 60, axis=0)
    classifier = CLASSIFIERS[name](**({"iterations": 1000} if name == "mlp" else {}))
    classifier.fit(features, labels)
    assert np.mean(classifier.predict(features) == labels) > 0.99


def test_properties_of_table_6():
    mlp, svm, rf, knn, nb = (CLASSIFIERS[name]().get_params() for name in TABLE_6)
    assert (mlp["hidden_layer_sizes"], mlp["activation"]) == ((10, 10, 10), "relu")
    assert svm["kernel"] == "rbf"
    assert (rf["n_estimators"], rf["max_depth"]) == (100, 7)
    assert knn["n_neighbors"] == 3
    assert nb["priors"] is None


def test_the_same_seed_gives_the_same_forest():
    rng = np.random.default_rng(0)
    features, labels = rng.standard_normal((60, 4)), rng.choice(["a", "b"], 60)
    first, second = (classical.random_forest(trees=5, seed=0) for _ in range(2))
    for forest in (first, second):
        forest.fit(features, labels)
    query = rng.standard_normal((200, 4))
    assert np.array_equal(first.predict(query), second.predict(query))
