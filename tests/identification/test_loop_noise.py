"""White noise is found between the integer orders."""

import numpy as np
import pytest
from loop_fixtures import POINTS, recorded, turning
from scipy.signal import lfilter

from swgsim.identification.data.features import Layout, features
from swgsim.identification.data.noise import floors, variance

LAYOUT = Layout(("s1",))
LEVEL = 0.03


def noisy(revolutions: float, seed: int, *, lines: float = 0.0, repeats: int = 1) -> list:
    """White noise on order 2, with a line of the cage and one of the mains."""
    rng = np.random.default_rng(seed)
    phi = turning(POINTS[0], revolutions, 10_000.0)
    time = np.arange(len(phi)) / 10_000.0
    disturbing = lines * (np.cos(0.455 * phi) + np.cos(2 * np.pi * 50 * time))
    return [
        recorded({"phi_in": phi, "s1": np.cos(2 * phi) + disturbing + LEVEL * rng.standard_normal(len(phi))})
        for _ in range(repeats)
    ]


def level(recordings: list) -> float:
    """Variance of the noise at 100 Hz."""
    return float(floors(recordings, LAYOUT)[0].at(np.array([100.0]))[0])


@pytest.mark.parametrize("revolutions", [5.0, 12.0, 30.0])
def test_the_level_of_white_noise_is_found(revolutions):
    # Twenty recordings of five revolutions have some 800 lines; their median is good to 5 %.
    assert level(noisy(revolutions, 1, repeats=20)) == pytest.approx(LEVEL**2, rel=0.15)


@pytest.mark.parametrize("line", [0.3, 1.0, 3.0])
def test_lines_of_the_cage_and_the_mains_do_not_move_it(line):
    assert level(noisy(12, 2, lines=line * LEVEL, repeats=20)) == pytest.approx(LEVEL**2, rel=0.3)


def test_slow_noise_is_seen_where_it_is():
    rng = np.random.default_rng(5)
    phi = turning(POINTS[0], 12, 10_000.0)
    recordings = []
    for _ in range(20):
        # An autoregression of order one that forgets over 0.02 s, ten times the white noise at frequency 0.
        steps = lfilter([1], [1, -np.exp(-1 / 200)], rng.standard_normal(len(phi) + 4000))[4000:]
        slow = 10 * LEVEL * (1 - np.exp(-1 / 200)) * steps
        recordings.append(recorded({"phi_in": phi, "s1": slow + LEVEL * rng.standard_normal(len(phi))}))
    # The lowest line between the orders, the second of 12 revolutions, lies at 5.6 Hz.
    found = floors(recordings, LAYOUT)[0].at(np.array([6.0, 1000.0])) / LEVEL**2
    expected = 1 + 100 / (1 + (np.array([6.0, 1000.0]) * 2 * np.pi / 50) ** 2)
    np.testing.assert_allclose(found, expected, rtol=0.3)


def test_features_scatter_as_their_variance_says():
    recordings = noisy(12, 3, repeats=150)
    values = np.array([features(each, LAYOUT) for each in recordings])
    said = variance(recordings, LAYOUT, floors(recordings, LAYOUT)).mean(axis=0)
    # A variance from 150 values is good to 12 %.
    np.testing.assert_allclose(values.var(axis=0, ddof=1) / said, 1, atol=0.5)
    assert np.mean(values.var(axis=0, ddof=1) / said) == pytest.approx(1, abs=0.1)


def test_a_channel_without_noise_still_has_a_floor():
    phi = turning(POINTS[0], 12, 10_000.0)
    recordings = [recorded({"phi_in": phi, "s1": np.cos(2 * phi)})]
    assert variance(recordings, LAYOUT, floors(recordings, LAYOUT)).min() > 1e-10


def test_a_recording_too_short_is_refused():
    with pytest.raises(ValueError, match=r"recording a: 1\.0 revolutions leave .* record 4 revolutions or more"):
        floors(noisy(1.0, 4), LAYOUT)
