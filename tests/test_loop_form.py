"""Deviations of the gauges' maps, order by order."""

import numpy as np
import pytest
from loop_fixtures import POINTS

from swgsim.conditions import Conditions
from swgsim.effects.frozen import FULL_LOAD
from swgsim.loop.features import Layout
from swgsim.loop.form import form_columns, largest_lines, learned_columns
from swgsim.loop.model import Situation

LAYOUT = Layout(("T_in", "s0", "s1"))
SITUATIONS = tuple(Situation(point, Conditions()) for point in POINTS)


@pytest.fixture
def predicted() -> np.ndarray:
    """Features of every situation."""
    return np.random.default_rng(1).normal(size=(len(SITUATIONS), len(LAYOUT)))


def test_only_gauges_deviate_and_by_a_share_of_their_largest_line(predicted):
    found = form_columns(largest_lines(predicted, LAYOUT), SITUATIONS, LAYOUT, 2)
    assert found.shape == (*predicted.shape, 2 * 2 * 25)
    assert not found[:, LAYOUT.channel == "T_in"].any()
    largest = np.abs(LAYOUT.lines(predicted))[:, 1, 1:].max()
    assert found[:, LAYOUT.channel == "s0"].max() == pytest.approx(largest)


def test_every_second_deviation_grows_with_the_load(predicted):
    found = form_columns(largest_lines(predicted, LAYOUT), SITUATIONS, LAYOUT, 2)
    load = np.array([point.T_out for point in POINTS]) / FULL_LOAD
    np.testing.assert_allclose(found[..., 1::2], found[..., ::2] * load[:, None, None])


def test_a_deviation_is_the_same_whatever_else_is_asked(predicted):
    """What commissioning found at six operating points holds for a question about one of them."""
    largest = largest_lines(predicted, LAYOUT)
    whole, part = (form_columns(largest, situations, LAYOUT, 2) for situations in (SITUATIONS, SITUATIONS[:1]))
    np.testing.assert_allclose(part, whole[:1])


def test_a_line_that_is_learned_follows_load_and_speed_alone():
    """Others stay as they are; a law of load and speed within those that are open is passed exactly."""
    learned = np.where((LAYOUT.channel == LAYOUT.channels[0]) & (LAYOUT.order == 3), 2.0, 0.0)
    found = learned_columns(learned, SITUATIONS, LAYOUT)
    assert not found[:, learned == 0].any()
    own = found[:, np.flatnonzero(learned)[0]]
    load, speed = (np.array([getattr(s.point, name) for s in SITUATIONS]) for name in ("T_out", "n_in_rpm"))
    for law in (1 + 0 * load, 0.3 * load - 1e-3 * speed, load**2 + 1e-3 * load * speed):
        np.testing.assert_allclose(own @ np.linalg.lstsq(own, law)[0], law, atol=1e-8 * np.abs(law).max())
    assert learned_columns(0 * learned, SITUATIONS, LAYOUT).shape == (*found.shape[:2], 0)
