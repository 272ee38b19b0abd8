"""Every classifier of conf/classifier beats chance; MiniRocket needs a signal and aeon."""

import builtins
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import yaml
from fabricated import recordings
from sklearn.base import clone

from learn.adaptation.transfer import untrained
from learn.evaluation import models
from learn.evaluation.evaluate import evaluate
from learn.inputs.signals import Signals
from learn.jobs import settings
from learn.methods import classical, rocket, strong
from learn.protocols.splits import Split

CONF = Path(__file__).parents[2] / "conf" / "classifier"
# Twins and the set network take other rows (test_twin_classifier.py, test_fast_twin.py, test_recording_sets.py).
OTHER_ROWS = ("own", "twin", "fast_twin", "set_network")
NAMES = sorted(path.stem for path in CONF.glob("*.yaml") if path.stem not in OTHER_ROWS)
# What would take long, and what does not change whether a method learns.
QUICK = {
    "cnn": {"width": 8, "batch": 16}, "perceptron": {"neurons": 32, "batch": 16}, "minirocket": {"kernels": 84},
    "extra_trees": {"trees": 30}, "gradient_boosting": {"rounds": 10}, "mlp": {"neurons": 30, "iterations": 500},
}  # fmt: skip
needs_aeon = pytest.mark.skipif(find_spec("aeon") is None, reason="aeon is not installed: pip install .[rocket]")


def configuration(name):
    return yaml.safe_load((CONF / f"{name}.yaml").read_text().replace("${seed}", "0"))


@pytest.fixture(scope="module")
def data():
    """Two gears with four variants of each class; speed and load, which the plain methods do not scale, left out."""
    signals = Signals("raw", points=16, orders=7, operating_point=False)
    return signals.learning_set([recordings(gears=2, variants=4)])


@pytest.fixture(scope="module")
def names(data):
    return data.table["label"].astype(str).to_numpy()


@pytest.mark.parametrize("name", [pytest.param(n, marks=[needs_aeon] * (n == "minirocket")) for n in NAMES])
def test_every_classifier_of_the_configuration_beats_chance_on_new_rows(name, data, names):
    make = settings.classifier(configuration(name), data.layout)
    rows = np.arange(len(names))
    split = Split("halves", rows[::2], rows[1::2])
    found = evaluate(data.features, names, [split], lambda: make(**QUICK.get(name, {})))
    np.testing.assert_allclose(found.probabilities.sum(axis=1), 1, atol=1e-6)
    assert (found.probabilities >= 0).all()
    chance, tested = 1 / 6, len(split.test)
    assert found.scores[0].test > 100 * (chance + 4 * np.sqrt(chance * (1 - chance) / tested))  # binomial


@pytest.mark.parametrize("name", NAMES)
def test_every_trial_of_a_classifier_makes_another_one(name, data):
    config = configuration(name)
    make, trials = settings.classifier(config, data.layout), settings.trials(config)
    assert len({repr(made) for made in (make(**trial) for trial in trials)}) == len(trials)
    assert len(trials) in (1, 2)  # the same number for every method that has something to choose


SEEDED = (
    strong.logistic_regression,
    lambda: strong.gradient_boosting(rounds=3),
    lambda: strong.extra_trees(3),
    lambda: classical.random_forest(3),
)


@pytest.mark.parametrize("make", SEEDED)
def test_a_method_is_an_estimator_that_gives_the_same_for_a_seed(make, data, names):
    one, other = make().fit(data.features, names), clone(make()).fit(data.features, names)
    assert np.array_equal(one.predict_proba(data.features), other.predict_proba(data.features))
    assert one.classes_.tolist() == sorted(set(names))


def test_properties_of_table_6_and_options_reach_the_estimators():
    mlp, svm, rf, knn, nb = (settings.CLASSIFIERS[name]().get_params() for name in ("mlp", "svm", "rf", "knn", "nb"))
    assert (mlp["hidden_layer_sizes"], mlp["activation"]) == ((10, 10, 10), "relu")
    assert svm["kernel"] == "rbf"
    assert (rf["n_estimators"], rf["max_depth"]) == (100, 7)
    assert knn["n_neighbors"] == 3
    assert nb["priors"] is None
    for estimator, wanted in (
        (strong.logistic_regression(0.5, 7, 3)[-1], {"C": 0.5, "max_iter": 7, "random_state": 3}),
        (strong.gradient_boosting(9, 0.2, 5, 0.7, 3), {"learning_rate": 0.2, "max_leaf_nodes": 5, "max_features": 0.7}),
        (strong.gradient_boosting(9, 0.2, 5, 0.7, 3), {"max_iter": 9, "random_state": 3}),
        (strong.extra_trees(9, 4, 0.7, 3), {"n_estimators": 9, "min_samples_leaf": 4, "max_features": 0.7}),
        (strong.extra_trees(9, 4, 0.7, 3), {"random_state": 3}),
    ):
        assert estimator.get_params().items() >= wanted.items()


def test_one_severe_fault_hardly_changes_logistic_regression(data, names):
    """A row that is thousands of times the others hardly changes their predictions."""
    severe = data.features.copy()
    severe[0] *= 1e4
    before, after = (
        strong.logistic_regression().fit(X, names).predict(data.features[1:]) for X in (data.features, severe)
    )
    assert np.mean(before == after) > 0.9


@pytest.fixture(scope="module")
def minirocket(data, names):
    pytest.importorskip("aeon", reason="aeon is not installed: pip install .[rocket]")
    return rocket.MiniRocket(*data.layout, kernels=84).fit(data.features, names)


def test_minirocket_gives_probabilities_uses_auxiliary_inputs_and_comes_back_from_its_file(
    minirocket, data, names, tmp_path
):
    probabilities = minirocket.predict_proba(data.features)
    np.testing.assert_allclose(probabilities.sum(axis=1), 1)
    assert np.array_equal(minirocket.classes_[probabilities.argmax(axis=1)], minirocket.predict(data.features))
    assert np.mean(minirocket.predict(data.features) == names) > 0.9
    moved = data.features.copy()
    moved[:, data.layout.columns :] += 0.5
    assert not np.allclose(minirocket.predict_proba(moved), probabilities)
    models.save(minirocket, tmp_path / "model.skops")
    assert np.array_equal(models.load(tmp_path / "model.skops").predict_proba(data.features), probabilities)


def test_minirocket_does_without_auxiliary_inputs(minirocket, data, names):
    bare = data.features[:, : data.layout.columns]
    model = untrained(minirocket, seed=1).fit(bare, names)
    assert (model.seed, minirocket.seed) == (1, 0)
    assert np.mean(model.predict(bare) == names) > 0.5


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ((0, 0), "at least 9 points, found 0 channels of 0: take features=raw"),
        ((1, 8), "at least 9 points, found 1 channels of 8: take features=raw"),
        ((1, 16, True, 83), "kernels of MiniRocket is 83, must be an integer from 84"),
    ],
)
def test_minirocket_refuses_other_features_and_few_kernels(options, message):
    with pytest.raises(ValueError, match=message):
        rocket.MiniRocket(*options)


def test_minirocket_names_the_library_that_is_missing(data, names, monkeypatch):
    original = builtins.__import__

    def without_aeon(name, *rest):
        if name.startswith("aeon"):
            raise ImportError(name)
        return original(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without_aeon)
    with pytest.raises(ValueError, match=r"needs the library aeon: pip install 'swg-workbench\[rocket\]'"):
        rocket.MiniRocket(*data.layout, kernels=84).fit(data.features, names)
