"""A regularity without a cause: its order, pattern, law and phase are what its parameters say."""

import numpy as np
import pytest
from loop_fixtures import POINTS, recorded, turning

from swgsim.effects.base import Scene
from swgsim.effects.regularity import LAWS, PATTERNS, Regularity
from swgsim.effects.text import as_text, from_text
from swgsim.gear.conditions import Conditions
from swgsim.identification.data.features import Layout, features
from swgsim.identification.search.regularities import Atom, Described
from swgsim.recordings.recording import CHANNELS

LAYOUT = Layout(("n_in", "T_in", "T_out", "s0", "s1", "s2", "s3", "s4"))


WARM_AND_LATE = Conditions(35.0, 1800.0)


def lines(effect: Regularity, point=POINTS[-1]) -> np.ndarray:
    """Order lines of silent channels with the effect."""
    phi = turning(point, 3, 10_000.0)
    time = np.arange(len(phi)) / 10_000.0
    silent = {name: np.zeros(len(phi)) for name in CHANNELS} | {"phi_in": phi}
    seen = effect.acquisition(silent, Scene(time, phi, np.full(len(phi), point.T_out), point, WARM_AND_LATE))
    return LAYOUT.lines(features(recorded(dict(seen), point), LAYOUT))


@pytest.mark.parametrize("pattern", PATTERNS)
def test_it_is_one_line_with_the_weights_of_its_pattern(pattern):
    found = lines(Regularity(3, 2e-3, 0.7, pattern))
    expected = np.zeros_like(found)
    for channel, weight in PATTERNS[pattern].items():
        expected[LAYOUT.channels.index(channel), 3] = 2e-3 * weight * np.exp(-0.7j)
    np.testing.assert_allclose(found, expected, atol=1e-12)


@pytest.mark.parametrize(
    ("law", "factor"),
    list(zip(LAWS, (1, 39 / 70, (39 / 70) ** 2, (39 / 70) ** 0.5, 0.5, 0.25, 39 / 140, 1, 0.5), strict=True)),
)
def test_its_size_follows_its_law(law, factor):
    found = lines(Regularity(2, 1e-3, 0.0, "in s1 alone", law), POINTS[1])
    assert abs(found[4, 2]) == pytest.approx(1e-3 * factor)


@pytest.mark.parametrize("order", [0, 3])
def test_what_was_described_is_what_is_added(order):
    """A negative mean, and a phase."""
    described = Described(Atom(order, "in s2 alone", "constant"), 100.0, 2, 2e-3, np.pi if order == 0 else 2.0)
    found = lines(described.effect)[5, order]
    assert found == pytest.approx(-2e-3 if order == 0 else 2e-3 * np.exp(-2j))


def test_it_comes_back_from_text_and_says_what_it_knows():
    effect = Regularity(3, 1e-3, 0.5, "opposite in s1 and s3", "proportional to the load")
    assert from_text(as_text([effect]), "text") == (effect,)
    with pytest.raises(ValueError, match=r"unknown choice 'in s9 alone' of pattern of regularity; choose from"):
        Regularity(3, 1e-3, 0.5, "in s9 alone")
