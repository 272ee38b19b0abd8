"""Deviations of the gauges' maps, order by order."""

import numpy as np
import pytest
from loop_fixtures import POINTS

from swgsim.conditions import Conditions
from swgsim.effects.frozen import FULL_LOAD
from swgsim.loop.features import Layout
from swgsim.loop.form import form_columns, largest_lines
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
