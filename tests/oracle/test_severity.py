"""Severity and position from the cells of a class, against exact mixtures; finer cells against a Fourier series."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import norm

from swgsim.bench.scatter import Bench
from swgsim.oracle.cells import UNIFORM, Cells, Partition
from swgsim.oracle.model import ORDERS
from swgsim.oracle.oracle import FEATURES
from swgsim.oracle.point import Places, PointModel
from swgsim.oracle.recording_errors import with_recording_errors
from swgsim.oracle.severity import Severities, positions
from swgsim.storage.labelled_signals import SENSORS

PARTITION = Partition("tip_tooth_crack", 0.5, 1.0, severities=5, positions=4, nodes=2)


def test_cells_have_their_middles_and_widths() -> None:
    middles = PARTITION.middles
    assert middles.shape == (20, 2)
    np.testing.assert_allclose(middles[0], [0.55, np.pi / 4])
    np.testing.assert_allclose(middles[-1], [0.95, 7 * np.pi / 4])
    np.testing.assert_allclose(PARTITION.widths, [0.1, np.pi / 2])


def test_finer_cells_follow_a_fourier_series() -> None:
    coarse = Partition("eccentric_wave_generator", 1e-5, 9e-5, severities=2, positions=8, nodes=3)
    fine = replace(coarse, finer=5)

    def change(severity: np.ndarray, position: np.ndarray) -> np.ndarray:
        return 1e5 * severity * (1 + np.cos(position - 0.4) + 0.3 * np.sin(3 * position))

    simulated = np.array([[change(v.severity, v.position)] for v in coarse.variants()])
    assert len(fine.variants()) == len(coarse.variants())
    shift = fine.cells(simulated).shift
    np.testing.assert_allclose(shift[:, 0], change(*fine.middles.T), atol=1e-12)


def test_quantiles_are_those_of_the_mixture_between_the_extremes() -> None:
    weight = np.zeros((1, 20))
    weight[0, [0, 4]] = 0.3, 0.7
    mean = np.zeros((1, 20, 2))
    mean[0, 0, 0] = -1.0
    found = Severities.of(PARTITION, Places(weight, mean, np.full((20, 2), 0.5)))
    unit = UNIFORM * 0.1
    parts = [norm(0.55 - unit, 0.5 * unit), norm(0.65, 0.5 * unit)]

    def distribution(s: float) -> float:
        return float(np.dot([0.3, 0.7], [part.cdf(s) for part in parts]))

    for probability in (0.025, 0.5, 0.975):
        there = found.quantile(probability)[0]
        assert 0.5 <= there <= 1.0
        share = (distribution(there) - distribution(0.5)) / (distribution(1.0) - distribution(0.5))
        assert share == pytest.approx(probability, abs=2e-3)
        assert found.below(np.array([there]))[0] == pytest.approx(probability, abs=2e-3)


def test_places_are_the_posterior_within_a_cell() -> None:
    """One cell, one feature: a Gaussian prior times a Gaussian likelihood."""
    cells = Cells(np.ones((1, 1)), np.full((1, 1, 1), 3.0))
    model = PointModel(np.zeros(1), np.array([[4.0]]), {"tip_tooth_crack": cells})
    places = model.places(np.array([[5.0]]), "tip_tooth_crack")
    np.testing.assert_allclose(places.weight, 1)
    np.testing.assert_allclose(places.mean[0, 0, 0], 3 * (5 - 1) / (9 + 4))
    np.testing.assert_allclose(places.deviation[0, 0], np.sqrt(4 / (9 + 4)))


def test_positions_turn_around() -> None:
    weight = np.zeros((2, 20))
    weight[0, [0, 3]] = 0.5  # on both sides of s1, at pi / 4 and 7 pi / 4
    weight[1, [0, 1, 2, 3]] = 0.25
    mean, deviation = positions(PARTITION, Places(weight, np.zeros((2, 20, 2)), np.zeros((20, 2))))
    assert np.cos(mean[0]) == pytest.approx(1)
    assert deviation[0] == pytest.approx(np.sqrt(np.log(2)))
    assert deviation[1] > 5


def test_a_change_follows_load_and_trigger() -> None:
    """A cosine of order 3 in s1 that is turned by an angle, against the same by trigonometry."""
    means = len(SENSORS) * (ORDERS + 1)
    cosine, sine = ORDERS + 1 + 3, means + ORDERS + 2
    shift = np.zeros((1, FEATURES))
    shift[0, cosine], shift[0, sine], shift[0, ORDERS + 1] = 2 * np.cos(0.5), 2 * np.sin(0.5), 7.0
    cells = with_recording_errors(Cells(shift, np.zeros((1, 1, FEATURES))), Bench(load=0.01, index_angle=1e-4))
    assert cells.spread.shape == (1, 3, FEATURES)
    np.testing.assert_allclose(cells.spread[0, 1], 0.01 * shift[0])
    turned = np.zeros(FEATURES)
    turned[cosine], turned[sine] = 2 * np.cos(0.5 + 3e-4), 2 * np.sin(0.5 + 3e-4)
    both = [cosine, sine]
    np.testing.assert_allclose(cells.spread[0, 2, both], turned[both] - shift[0, both], rtol=1e-3)
    assert np.count_nonzero(cells.spread[0, 2]) == 2
