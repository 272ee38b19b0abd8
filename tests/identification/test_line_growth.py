"""Lines between the orders that the healthy gear shows as well are no news, unless they have grown."""

from collections.abc import Sequence

import numpy as np
import pytest
from loop_fixtures import POINTS
from sideline_fixtures import NOISE, measured

from swgsim.effects.line_between import FixedFrequency, FractionalOrder
from swgsim.identification.interharmonics.interharmonic_spectrum import GaugeSpectrum, gauge_spectra
from swgsim.identification.interharmonics.line_growth import chance_of_growth
from swgsim.identification.interharmonics.line_search import search

pytestmark = pytest.mark.end_to_end
LEVEL = 0.005
TWICE = 2 * list(POINTS[4:])


def line(amplitude: float, order: float = 5.37) -> FractionalOrder:
    return FractionalOrder(amplitude, order=order)


def seen(seed: int, *amplitudes: float, points: Sequence = TWICE) -> list[GaugeSpectrum]:
    """Recordings, two at each point, with as many amplitudes of a line as are given in turn."""
    each = [
        measured((line(amplitudes[i % len(amplitudes)]),), 100 * seed + i, [point])[0] for i, point in enumerate(points)
    ]
    return gauge_spectra(each)


def test_noise_is_growth_as_often_as_it_should_be():
    before, now = seen(1, 0.0), seen(2, 0.0)
    chances = np.array([chance_of_growth([line(1.0, order)], now, before) for order in np.arange(2.37, 12.0, 0.41)])
    assert 0.3 < chances.mean() < 0.7
    assert (chances < 0.05).mean() <= 0.05 + 3 * np.sqrt(0.05 / len(chances))


@pytest.mark.parametrize(("growth", "news"), [(1.2, False), (4.0, True)])
def test_a_line_of_the_healthy_gear_is_news_only_if_it_has_grown(growth, news):
    before, now = seen(1, 2 * NOISE), seen(2, 2 * NOISE * growth)
    found = search(now, (), LEVEL, healthy=before)
    assert bool(found.unnamed) == news
    assert bool(found.usual) != news
    assert found.effects


def test_what_scatters_from_recording_to_recording_must_grow_by_more():
    steady, unsteady = (seen(1, *each) for each in ([0.01] * 4, [0.004, 0.004, 0.012, 0.012]))
    grown = seen(2, 0.03)
    assert chance_of_growth([line(1.0)], grown, steady) < LEVEL
    assert chance_of_growth([line(1.0)], grown, unsteady) > chance_of_growth([line(1.0)], grown, steady)


def test_a_new_line_is_news_beside_an_old_one():
    hum = FixedFrequency(5e-3, frequency=50.0)
    before = gauge_spectra([measured((hum,), i, [point])[0] for i, point in enumerate(TWICE)])
    now = gauge_spectra([measured((hum, line(2e-3)), 50 + i, [point])[0] for i, point in enumerate(TWICE)])
    (found,) = search(now, (), LEVEL, healthy=before).unnamed
    assert found.at == pytest.approx(5.37, abs=0.06)


def test_a_line_in_another_gauge_has_grown_there():
    before = seen(1, 2 * NOISE)
    gauge = FractionalOrder(1.0, order=5.37, pattern="in s2 alone")
    assert chance_of_growth([gauge], seen(2, 2 * NOISE), before) > LEVEL
    other = [
        measured((FractionalOrder(8 * NOISE, order=5.37, pattern="in s2 alone"),), 30 + i, [point])[0]
        for i, point in enumerate(TWICE)
    ]
    assert chance_of_growth([gauge], gauge_spectra(other), before) < LEVEL


def test_without_repeats_a_line_is_no_steadier_than_from_day_to_day():
    before = seen(1, 2 * NOISE, points=POINTS[3:])
    assert chance_of_growth([line(1.0)], seen(2, 2.4 * NOISE, points=POINTS[3:]), before) > LEVEL
    assert chance_of_growth([line(1.0)], seen(2, 8 * NOISE, points=POINTS[3:]), before) < LEVEL


def test_the_law_of_a_line_carries_it_to_other_operating_points():
    before, now = seen(1, 2 * NOISE, points=POINTS[3:4]), seen(2, 2 * NOISE, points=POINTS[4:])
    assert chance_of_growth([line(1.0)], now, before) > LEVEL
    assert chance_of_growth([line(1.0)], seen(2, 10 * NOISE, points=POINTS[4:]), before) < LEVEL
