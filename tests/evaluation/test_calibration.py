"""Calibration against probabilities whose truth is drawn from them."""

import numpy as np
import pytest

from learn.evaluation.probability_calibration import (
    apply_temperature,
    expected_calibration_error,
    fit_temperature,
    negative_log_likelihood,
    reliability,
    tempered_by_others,
)
from swgsim.common.seeds import generator


def calibrated(rows=20_000, classes=6):
    """Probabilities and classes drawn from them."""
    rng = generator("calibrated")
    probabilities = rng.dirichlet(np.full(classes, 0.4), rows)
    y = (probabilities.cumsum(axis=1) < rng.random((rows, 1))).sum(axis=1)
    return probabilities, np.minimum(y, classes - 1)


def test_calibrated_probabilities_lie_on_the_diagonal():
    table = reliability(*calibrated())
    assert len(table) == 15
    assert table["count"].to_numpy() == pytest.approx(20_000 / 15, abs=1)
    np.testing.assert_allclose(table["confidence"], table["accuracy"], atol=4 * 0.5 / np.sqrt(20_000 / 15))
    assert expected_calibration_error(table) < 2


def test_overconfidence_is_seen_and_its_temperature_found():
    probabilities, y = calibrated()
    sharp = apply_temperature(probabilities, 1 / 3)
    assert expected_calibration_error(reliability(sharp, y)) > 10
    assert fit_temperature(sharp, y) == pytest.approx(3, rel=0.05)
    assert fit_temperature(probabilities, y) == pytest.approx(1, rel=0.05)
    cured = apply_temperature(sharp, fit_temperature(sharp, y))
    assert negative_log_likelihood(cured, y) < negative_log_likelihood(sharp, y)


def test_errors_by_hand():
    probabilities = np.array([[0.9, 0.1], [0.9, 0.1], [0.4, 0.6], [0.4, 0.6]])
    table = reliability(probabilities, np.array([0, 1, 1, 1]), bins=2)
    assert table["accuracy"].tolist() == [1, 0.5]
    assert expected_calibration_error(table) == pytest.approx(100 * (0.4 + 0.4) / 2)
    table = reliability(np.tile([0.7, 0.3], (60, 1)), np.repeat([0, 1], 30))
    assert table["count"].tolist() == [60]  # rows of equal confidence share a bin
    assert expected_calibration_error(table) == pytest.approx(20)
    assert negative_log_likelihood(np.array([[1.0, 0.0]]), np.array([1])) == pytest.approx(6 * np.log(10))


def test_temperature_keeps_decisions_and_sums():
    probabilities, _ = calibrated(500)
    for temperature in (0.1, 1.0, 10.0):
        scaled = apply_temperature(probabilities, temperature)
        np.testing.assert_allclose(scaled.sum(axis=1), 1)
        np.testing.assert_array_equal(scaled.argmax(axis=1), probabilities.argmax(axis=1))
    with pytest.raises(ValueError, match="temperature 0 must be above 0"):
        apply_temperature(probabilities, 0)


def test_temperature_of_a_gear_does_not_rest_on_predictions_of_its_own():
    probabilities, y = calibrated(3000)
    gears = np.repeat([5, 7, 9], 1000)
    sharp = apply_temperature(probabilities, 1 / 3)
    cured, temperatures = tempered_by_others(sharp, y, gears)
    assert temperatures == pytest.approx([3, 3, 3], rel=0.15)
    assert negative_log_likelihood(cured, y) < negative_log_likelihood(sharp, y)
    other = np.where(gears == 5, 0, y)
    again, changed = tempered_by_others(sharp, other, gears)
    np.testing.assert_array_equal(again[:1000], cured[:1000])
    assert (changed[1:] != temperatures[1:]).all()
    with pytest.raises(ValueError, match=r"1 gear, at least 2 .* judge more gears"):
        tempered_by_others(probabilities[:5], y[:5], np.ones(5))
