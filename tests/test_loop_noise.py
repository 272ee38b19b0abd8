"""White noise is found between the integer orders."""

import numpy as np
import pytest
from loop_fixtures import POINTS, recorded, turning

from swgsim.loop.features import Layout, features
from swgsim.loop.noise import density, white_variance

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


@pytest.mark.parametrize("revolutions", [5.0, 12.0, 30.0])
def test_the_level_of_white_noise_is_found(revolutions):
    found = np.array([density(each, LAYOUT)[0] for each in noisy(revolutions, 1, repeats=40)]) / LEVEL**2
    # The median of n exponentials has a relative standard deviation of 1 / (sqrt(n) log 2).
    lines = 12.5 * (revolutions - 3)
    expected = 1 / (np.sqrt(lines) * np.log(2))
    assert found.mean() == pytest.approx(1, abs=4 * expected / np.sqrt(40) + 0.5 / lines)
    assert found.std() == pytest.approx(expected, rel=0.4)


LEAKS = pytest.mark.xfail(strict=True, reason="without a window a line leaks into the whole spectrum")


@pytest.mark.parametrize("line", [0.3, pytest.param(1.0, marks=LEAKS), pytest.param(50.0, marks=LEAKS)])
def test_lines_of_the_cage_and_the_mains_do_not_move_it(line):
    calm = np.mean([density(each, LAYOUT)[0] for each in noisy(12, 2, repeats=20)])
    disturbed = np.mean([density(each, LAYOUT)[0] for each in noisy(12, 2, lines=line * LEVEL, repeats=20)])
    assert disturbed == pytest.approx(calm, rel=0.3)


def test_features_scatter_as_their_variance_says():
    recordings = noisy(12, 3, repeats=150)
    values = np.array([features(each, LAYOUT) for each in recordings])
    said = white_variance(recordings, LAYOUT).mean(axis=0)
    # A variance from 150 values is good to 12 %.
    np.testing.assert_allclose(values.var(axis=0, ddof=1) / said, 1, atol=0.5)
    assert np.mean(values.var(axis=0, ddof=1) / said) == pytest.approx(1, abs=0.1)


def test_a_channel_without_noise_still_has_a_floor():
    phi = turning(POINTS[0], 12, 10_000.0)
    assert white_variance([recorded({"phi_in": phi, "s1": np.cos(2 * phi)})], LAYOUT).min() > 1e-10


def test_a_recording_too_short_is_refused():
    with pytest.raises(ValueError, match=r"recording a: 1\.0 revolutions leave .* record 4 revolutions or more"):
        density(noisy(1.0, 4)[0], LAYOUT)
