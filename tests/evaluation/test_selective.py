"""Selective decisions on cases that are known by hand or by theory."""

import numpy as np
import pytest

from learn.evaluation.selective import (
    area_under_risk,
    conformal_threshold,
    coverage_at,
    risk_coverage,
)
from swgsim.common.seeds import generator


def test_risk_by_hand():
    curve = risk_coverage(np.array([0.5, 0.9, 0.8, 0.6]), np.array([False, True, True, True]))
    assert curve["coverage"].tolist() == [0.25, 0.5, 0.75, 1]
    assert curve["risk"].tolist() == [0, 0, 0, 0.25]
    assert area_under_risk(curve) == pytest.approx(0.0625)
    assert coverage_at(curve, 0.05) == 0.75
    assert coverage_at(curve, 0.25) == 1


def test_no_coverage_where_the_most_confident_are_wrong_and_ties_are_decided_together():
    assert coverage_at(risk_coverage(np.array([0.9, 0.5]), np.array([False, True])), 0.01) == 0
    for correct in ([True, False, True, False], [False, False, True, True]):
        curve = risk_coverage(np.full(4, 0.7), np.array(correct))
        assert curve["risk"].tolist() == [0.5]
        assert area_under_risk(curve) == 0.5


def test_one_recording_per_gear_is_split_conformal():
    rng = generator("split conformal")
    probabilities = rng.dirichlet(np.ones(3), 99)
    y = rng.integers(3, size=99)
    threshold = conformal_threshold(probabilities, y, np.arange(99), nominal=0.9)
    true = np.sort(probabilities[np.arange(99), y])[::-1]
    assert threshold == true[int(np.ceil(0.9 * 100)) - 1]


def drawn(rng, gears, rows=30):
    """Two classes; the probability of the true one differs between gears more than within."""
    gear = np.repeat(np.arange(gears), rows)
    odds = rng.normal(1, 2, gears)[gear] + rng.normal(0, 0.5, len(gear))
    y = rng.integers(2, size=len(gear))
    true = 1 / (1 + np.exp(-odds))
    return np.where(np.arange(2) == y[:, None], true[:, None], 1 - true[:, None]), y, gear


def test_sets_hold_the_truth_of_new_gears_as_nominal():
    rng, coverage = generator("new gears"), []
    for _ in range(200):
        threshold = conformal_threshold(*drawn(rng, 19), nominal=0.8)
        probabilities, y, _ = drawn(rng, 5)
        coverage.append(np.mean(probabilities[np.arange(len(y)), y] >= threshold))
    assert 0.8 - 2 * np.std(coverage) / np.sqrt(200) <= np.mean(coverage) <= 0.8 + 1 / 20 + 0.03


def test_too_few_gears_for_the_coverage_give_full_sets():
    probabilities, y, gear = drawn(generator("few"), 8)
    assert conformal_threshold(probabilities, y, gear, nominal=0.9) == -np.inf
    with pytest.raises(ValueError, match="nominal coverage 95 must be between 0 and 1"):
        conformal_threshold(probabilities, y, gear, nominal=95)
