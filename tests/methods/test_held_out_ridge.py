"""A choice that leaves gears out is not misled by recordings that are alike within a gear."""

import numpy as np
import pytest
from sklearn.linear_model import RidgeClassifier

from learn.evaluation.evaluate import evaluate, fit
from learn.methods.held_out_ridge import FOLDS, held_out_decisions
from learn.methods.rocket import STRENGTHS, MiniRocket
from learn.protocols.splits import Split

GEARS, SPECIMENS, TWINS, POINTS = 8, 12, 4, 32


@pytest.fixture(scope="module")
def chance():
    """Signals that tell the specimen, of which there are near twins, and nothing of the class."""
    rng = np.random.default_rng(0)
    signals = np.repeat(rng.standard_normal((GEARS * SPECIMENS, POINTS)), TWINS, axis=0)
    signals += 0.01 * rng.standard_normal(signals.shape)
    y = np.array(["a", "b", "c"])[np.repeat(np.arange(GEARS * SPECIMENS) % 3, TWINS)]
    return signals, y, np.repeat(np.arange(GEARS), SPECIMENS * TWINS)


def test_decisions_are_those_of_a_ridge_classifier_that_never_saw_the_gear():
    rng = np.random.default_rng(1)
    gears = np.repeat(np.arange(FOLDS), 12)
    y = np.array(["a", "b", "c"])[np.arange(len(gears)) % 3]
    X = rng.standard_normal((len(gears), 6)) + (y == "b")[:, None]
    strengths = np.array([0.3, 30.0])
    found = held_out_decisions(X, y, gears, strengths)
    for decisions, strength in zip(found, strengths, strict=True):
        for gear in range(FOLDS):
            direct = RidgeClassifier(strength).fit(X[gears != gear], y[gears != gear])
            np.testing.assert_allclose(decisions[gears == gear], direct.decision_function(X[gears == gear]), atol=1e-9)


def test_without_gears_every_row_is_decided_once_by_a_fit_of_the_others(chance):
    X, y, _ = chance
    assert np.isfinite(held_out_decisions(X, y, None, STRENGTHS)).all()


def test_where_nothing_is_to_be_learned_minirocket_is_unsure_on_new_gears(chance):
    """Left out one by one, rows have a twin in training: the weakest ridge then seems best, and nearly certain."""
    pytest.importorskip("aeon", reason="aeon is not installed: pip install .[rocket]")
    X, y, gears = chance
    rows = np.arange(len(y))
    split = Split("halves", rows[gears < GEARS // 2], rows[gears >= GEARS // 2])
    found = evaluate(X, y, [split], lambda: MiniRocket(1, POINTS, kernels=420), gears)
    assert found.probabilities.max(axis=1).mean() < 0.45  # one third is right


def test_the_gear_is_given_to_methods_that_ask_for_it_only(chance):
    class DoesNot:
        def fit(self, X, y):
            self.gears = "none"

        def predict(self, X):
            return np.repeat("a", len(X))

    class Asks(DoesNot):
        def fit(self, X, y, gears=None):
            self.gears = gears

    X, y, gears = chance
    models = [Asks(), DoesNot()]
    for model in models:
        fit(model, X, y, gears)
    assert models[0].gears is gears
    assert models[1].gears == "none"
