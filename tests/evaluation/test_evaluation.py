"""Evaluation gives chance for guesses and 100 % for memorised rows, and keeps test rows out of training."""

import time

import numpy as np
import pandas as pd
import pytest

from learn.evaluation.evaluate import evaluate
from learn.methods import classical
from learn.protocols.splits import RandomFolds, Split
from swgsim.storage.labelled_signals import CLASSES

LABELS = np.repeat(CLASSES, 200)
TABLE = pd.DataFrame({"label": LABELS})


class Guesser:
    """Ignores its input."""

    def fit(self, X, y):
        self.classes, self.rng = np.unique(y), np.random.default_rng(0)

    def predict(self, X):
        return self.rng.choice(self.classes, len(X))


class Spy:
    """Remembers its training rows; it has the methods fit and predict only."""

    def fit(self, X, y):
        self.seen = dict(zip(X[:, 0], y, strict=True))

    def predict(self, X):
        return np.array([self.seen.get(x, "healthy") for x in X[:, 0]])


def test_a_classifier_that_ignores_its_input_scores_chance():
    features = np.zeros((len(LABELS), 1))
    result = evaluate(features, LABELS, RandomFolds().split(features, TABLE), Guesser)
    deviation = 100 * np.sqrt(1 / 6 * 5 / 6 / len(LABELS))  # binomial, in points
    assert result.metrics()["test_score"] == pytest.approx(100 / 6, abs=4 * deviation)
    assert result.metrics()["balanced_accuracy"] == pytest.approx(100 / 6, abs=4 * deviation)


def test_test_rows_are_not_in_training_and_the_confusion_counts_each_once():
    features = np.arange(len(LABELS), dtype=float)[:, None]
    result = evaluate(features, LABELS, RandomFolds().split(features, TABLE), Spy)
    assert result.metrics()["train_score"] == 100.0
    assert result.metrics()["test_score"] == 16.667  # all taken for healthy
    assert result.classes == CLASSES
    assert result.confusion.sum(axis=1).tolist() == [200] * 6
    assert result.confusion[:, result.classes.index("healthy")].tolist() == [200] * 6
    assert result.recall()["healthy"] == 100.0


def test_the_time_to_judge_is_that_of_one_row():
    class Slow(Spy):
        def predict(self, X):
            time.sleep(0.02)
            return super().predict(X)

    split = Split("two", np.array([2, 3]), np.array([0, 1]))
    result = evaluate(np.arange(4.0)[:, None], np.array(["a", "b", "a", "b"]), [split], Slow)
    assert 10 <= result.metrics()["milliseconds"] < 1000


def test_a_class_that_is_not_tested_has_no_recall():
    labels = np.array(["a", "a", "a", "b", "b"])
    split = Split("only a", np.array([1, 2, 3, 4]), np.array([0]))
    result = evaluate(np.array([[0.0], [0.1], [0.2], [9.0], [9.1]]), labels, [split], classical.naive_bayes)
    assert dict(result.recall()) == {"a": 100.0}
    assert result.metrics()["test/only_a"] == 100.0


@pytest.mark.parametrize(("iterations", "converged"), [(2, 0.0), (2000, 1.0)])
def test_an_optimiser_that_stops_at_its_bound_is_reported(iterations, converged):
    rng = np.random.default_rng(0)
    labels = np.repeat(["a", "b"], 20)
    features = rng.standard_normal((40, 2)) + 9 * (labels == "b")[:, None]
    splits = RandomFolds(2).split(features, pd.DataFrame({"label": labels}))
    result = evaluate(features, labels, splits, lambda: classical.multi_layer_perceptron(iterations=iterations))
    assert result.metrics()["converged"] == converged
