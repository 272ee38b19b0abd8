"""A classifier of one's own is checked before it is trained, and the source of it is part of a job's key."""

import numpy as np
import pytest
from fabricated import recordings

from learn.evaluation import models
from learn.evaluation.evaluate import evaluate
from learn.inputs.inputs import Layout
from learn.inputs.signals import Signals
from learn.jobs import identity, settings
from learn.methods import contract
from learn.protocols.splits import RandomFolds

HERE = f"{__name__}:"


class Nearest:
    """The class with the nearest mean; it has no scikit-learn about it."""

    def __init__(self, channels, points, periodic, width=1.0):
        self.signal, self.width = channels * points, width

    def fit(self, X, y):
        self.classes_ = np.unique(y)
        self.means = np.array([X[y == name, : self.signal].mean(axis=0) for name in self.classes_])

    def predict_proba(self, X):
        distance = np.linalg.norm(X[:, None, : self.signal] - self.means, axis=2)
        closeness = np.exp(-(distance - distance.min(axis=1, keepdims=True)) / self.width)
        return closeness / closeness.sum(axis=1, keepdims=True)

    def predict(self, X):
        return self.classes_[self.predict_proba(X).argmax(axis=1)]


class FitAlone:
    def fit(self, X, y):
        raise NotImplementedError


class Sound:
    """Keeps the contract with one class always; tests spoil one thing of it at a time."""

    def fit(self, X, y):
        self.classes_ = np.unique(y)

    def predict(self, X):
        return np.repeat("healthy", len(X))

    def predict_proba(self, X):
        return np.tile([1.0, 0.0, 0.0], (len(X), 1))


@pytest.fixture(scope="module")
def data():
    return Signals("raw", points=16, orders=7).learning_set([recordings(gears=2, variants=4)])


def test_a_class_of_ones_own_is_evaluated_like_any_other(data, tmp_path):
    make = settings.classifier({"name": f"{HERE}Nearest", "width": 0.1}, data.layout)
    names = data.table["label"].astype(str).to_numpy()
    found = evaluate(data.features, names, RandomFolds().split(data.features, data.table), make)
    assert found.metrics()["test_score"] > 30  # chance is 17
    model = models.trained(tmp_path, "identity", make(), data.features, names)
    assert np.array_equal(model.classes_, np.unique(names))
    assert not list(tmp_path.iterdir())  # nothing is known of how to keep it


@pytest.mark.parametrize(
    ("name", "message"),
    [
        (f"{HERE}FitAlone", r"it has no predict\(X\), no predict_proba\(X\)\. .* needs fit\(X, y\), .* classes_"),
        (f"{HERE}HERE", "is a str, a class is needed"),
        (f"{HERE}Missing", "cannot be imported: .*Missing"),
        ("no_such_module:Net", "cannot be imported: No module named 'no_such_module'.*PYTHONPATH"),
        ("forest", "unknown classifier 'forest'; choose from mlp, .*, or give the import path module:Class"),
    ],
)
def test_what_is_no_classifier_is_refused_before_the_data_are_read(name, message):
    with pytest.raises(ValueError, match=message):
        settings.classifier({"name": name})
    with pytest.raises(ValueError, match=r"unknown option 'depth' of classifier .*; choose from channels, points"):
        settings.classifier({"name": f"{HERE}Nearest", "depth": 3})


@pytest.mark.parametrize(
    ("method", "spoiled", "message"),
    [
        ("fit", lambda self, X, y: None, "fit sets no attribute classes_"),
        ("fit", lambda self, X: None, r"fit\(X, y\) failed in the trial before training, on 24 rows of 9 .* TypeError"),
        ("fit", lambda self, X, y: setattr(self, "classes_", [0, 1, 2]), r"classes_ is \[0, 1, 2\] for .* \[healthy, "),
        ("predict_proba", lambda self, X: np.ones((len(X), 2)), r"has shape \(24, 2\), expected \(24, 3\)"),
        ("predict_proba", lambda self, X: np.ones((len(X), 3)), "each must be >= 0 and sum to 1"),
        ("predict", lambda self, X: np.zeros(len(X)), r"predict\(X\) gives \[0.0, 0.0, 0.0\], expected one class name"),
        ("predict", lambda self, X: 1 / 0, "ZeroDivisionError"),
    ],
)
def test_a_broken_contract_is_found_in_a_trial_before_training(method, spoiled, message, monkeypatch):
    config = {"name": f"{HERE}Sound"}
    assert isinstance(settings.classifier(config, Layout(1, 1))(), contract.Classifier)
    monkeypatch.setattr(Sound, method, spoiled)
    with pytest.raises(ValueError, match=message):
        settings.classifier(config, Layout(1, 1))


def test_a_changed_source_changes_the_key_of_a_job(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    source = "class Net:\n    fit = predict = predict_proba = lambda self, *rows: None\n"
    for module in ("own_net.py", "own_package/nets.py", "own_package/layers.py"):
        (tmp_path / module).parent.mkdir(exist_ok=True)
        (tmp_path / module).write_text(source)

    def key(name):
        return identity.job_key({"classifier": {"name": name}}, "data")

    names = ("own_net:Net", "own_package.nets:Net", "rf")
    before = [key(name) for name in names]
    assert before == [key(name) for name in names]
    for changed, module in ([0], "own_net.py"), ([1], "own_package/layers.py"):
        (tmp_path / module).write_text(source + "\n")
        assert [i for i, name in enumerate(names) if key(name) != before[i]] == changed
        (tmp_path / module).write_text(source)
