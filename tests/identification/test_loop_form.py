"""Lines of a gear that lie elsewhere than the chain's: of the gauges' maps, and those that are learned."""

from dataclasses import replace

import numpy as np
import pytest
from loop_fixtures import GEAR, POINTS

from swgsim.effects import Effect
from swgsim.effects.base import Scene
from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.library import LIBRARY
from swgsim.gear.conditions import Conditions
from swgsim.identification.covariance.influence_map_error import form_columns, largest_lines, lines_of, sizes_of
from swgsim.identification.data.features import ORDERS, Layout
from swgsim.identification.data.model import Model, Situation, predict
from swgsim.identification.data.unit_lines import LAWS, Lines, OwnLines
from swgsim.identification.fit.unit import STRUCTURE, Unit

LAYOUT = Layout(("T_in", "s0", "s1"))
SITUATIONS = tuple(Situation(point, Conditions()) for point in POINTS)


TORQUE = predict([Model(GEAR)], SITUATIONS, Layout(("T_out",)))[0]
EVEN = TORQUE * (np.arange(TORQUE.shape[1]) == 0)
# What orders beyond those compared make, and angles that are not passed evenly [mV/V].
MISSED = 1e-5
MAPS = 0.01 * (LAYOUT.channel != "T_in")
LEARNED = np.where((LAYOUT.channel == "T_in") & (LAYOUT.order == 3), 2.0, 0.0)
SIZES = sizes_of(MAPS, 3, LEARNED)


def test_runs_that_are_alike_are_predicted_alike_in_any_order():
    other = Model(replace(GEAR, gauges=replace(GEAR.gauges, gain=(1.1,) * 5)))
    found = predict([other, Model(GEAR), other], SITUATIONS[::-1], LAYOUT, sectors=40)
    alone = predict([Model(GEAR)], SITUATIONS, LAYOUT, sectors=40)[0, ::-1]
    np.testing.assert_allclose(found[1], alone, rtol=0, atol=1e-10)
    gain = np.where(LAYOUT.channel == "T_in", 1.0, 1.1)
    for each in found[[0, 2]]:
        np.testing.assert_allclose(each, gain * alone, rtol=0, atol=1e-8)


def test_half_of_the_deviations_of_a_map_grow_with_the_load():
    found = form_columns(sizes_of(MAPS, 2, 0 * MAPS), SITUATIONS, LAYOUT, EVEN)
    assert found.shape == (len(SITUATIONS), len(LAYOUT), 2 * 2 * 25)
    assert not found[:, LAYOUT.channel == "T_in"].any()
    constant, with_load = np.split(found, 2, axis=-1)
    assert constant[:, LAYOUT.channel == "s0"].max() == pytest.approx(0.01)
    load = np.array([point.T_out for point in POINTS]) / FULL_LOAD
    np.testing.assert_allclose(with_load, constant * load[:, None, None], atol=1e-12)


def test_only_maps_of_gauges_deviate_and_by_a_share_of_their_largest_line():
    predicted = np.random.default_rng(1).normal(size=(len(SITUATIONS), len(LAYOUT)))
    found = Unit(Model(GEAR), structure=0.03).form(predicted, LAYOUT)
    largest = largest_lines(predicted, LAYOUT)
    assert largest["s0"] == np.abs(LAYOUT.lines(predicted))[:, 1, 1:].max()
    expected = {"T_in": 0.0, "s0": STRUCTURE * largest["s0"], "s1": STRUCTURE * largest["s1"]}
    np.testing.assert_allclose(found[:2], [[expected[name] for name in LAYOUT.channel]] * 2)
    assert not found[2:].any()


def test_a_line_that_is_learned_deviates_by_its_map_too_and_by_laws_of_its_own():
    found = sizes_of(MAPS, 3, 2 * MAPS)
    np.testing.assert_allclose(found[:3] ** 2, [5 * MAPS**2] * 3)
    np.testing.assert_allclose(found[3:], [2 * MAPS] * (len(LAWS) - 3))


def test_a_deviation_is_the_same_whatever_else_is_asked():
    """What commissioning found at six operating points holds for a question about one of them."""
    whole, part = (form_columns(SIZES, SITUATIONS[:n], LAYOUT, TORQUE[:n]) for n in (len(SITUATIONS), 1))
    np.testing.assert_allclose(part, whole[:1])


def test_a_line_that_is_learned_follows_load_and_speed_alone():
    """Others stay as they are; a law of load and speed within those that are open is passed exactly."""
    found = form_columns(sizes_of(0 * MAPS, 2, LEARNED), SITUATIONS, LAYOUT, TORQUE)
    assert not found[:, LEARNED == 0].any()
    own = found[:, np.flatnonzero(LEARNED)[0]]
    load, speed = (np.array([getattr(s.point, name) for s in SITUATIONS]) for name in ("T_out", "n_in_rpm"))
    for law in (1 + 0 * load, 0.3 * load - 1e-3 * speed, load**2 + 1e-3 * load * speed):
        np.testing.assert_allclose(own @ np.linalg.lstsq(own, law)[0], law, atol=1e-8 * np.abs(law).max())
    assert form_columns(0 * SIZES, SITUATIONS, LAYOUT, TORQUE).shape == (*found.shape[:2], 0)


@pytest.fixture(scope="module")
def of_form() -> tuple[np.ndarray, Model]:
    """Features that columns make together, and a model that has them as its deviation."""
    columns = form_columns(SIZES, SITUATIONS, LAYOUT, TORQUE)
    found = np.random.default_rng(1).normal(size=columns.shape[-1])
    return columns @ found, Model(GEAR, (), lines_of(SIZES, found, LAYOUT, GEAR.gauges))


def test_a_model_has_the_deviation_that_its_columns_make(of_form):
    """With what the ripple of the torque makes of it, which alone is a hundred times as much as may be missed."""
    features, deviating = of_form
    without, beside = predict([Model(GEAR), deviating], SITUATIONS, LAYOUT, sectors=40)
    np.testing.assert_allclose(beside - without, features, atol=MISSED)


def with_and_without(deviating: Model, effect: Effect) -> np.ndarray:
    """Lines of what a deviation adds to a model that has an effect."""
    without, beside = predict([Model(GEAR, (effect,)), deviating.plus(effect)], SITUATIONS, LAYOUT, sectors=40)
    return LAYOUT.lines(beside - without)


def test_a_gain_scales_the_deviation_of_its_gauge_too(of_form):
    features, deviating = of_form
    expected = LAYOUT.lines(features) * np.array([1, 0.6, 1])[:, None]
    found = with_and_without(deviating, LIBRARY["gauge_gain"](sensor=0, share=-0.4))
    np.testing.assert_allclose(found, expected, atol=MISSED)


def test_a_gauge_that_has_moved_sees_its_deviation_later():
    """Where the load is even; the ripple of the torque is felt at all angles at once."""
    lines = np.zeros((5, 1, ORDERS + 1), complex)
    lines[0, 0, [1, 2, 5]] = 0.01, 0.02j, 0.03
    deviating = Model(GEAR, (), Lines(("s0",), lines, GEAR.gauges))
    found = with_and_without(deviating, LIBRARY["gauge_position"](sensor=0, shift=0.05))
    expected = lines[0, 0] * np.exp(-0.05j * np.arange(ORDERS + 1))
    np.testing.assert_allclose(found[:, 1], np.tile(expected, (len(SITUATIONS), 1)), atol=1e-9)


@pytest.mark.parametrize(
    ("effect", "scaled", "ahead"),
    [
        (LIBRARY["worn_wave_generator"](0.1), 0.9, 0.0),
        (LIBRARY["lobe_shift"](0.05), 1.0, 0.05),
        (LIBRARY["eccentric_wave_generator"](50e-6, 0.3), 1.0, 0.0),
    ],
    ids=["worn", "turned", "shifted"],
)
def test_lobes_take_the_deviation_along(effect, scaled, ahead):
    """With their stroke what is there without a load, and with their turn all of it."""
    lines = np.zeros((5, 1, ORDERS + 1), complex)
    lines[:2, 0, 2], lines[:2, 0, 5] = 0.01, 0.03j
    deviating = Model(GEAR, (), Lines(("s0",), lines, GEAR.gauges))
    found = with_and_without(deviating, effect)[:, 1]
    load = np.array([point.T_out for point in POINTS])[:, None] / FULL_LOAD
    turn = np.exp(1j * ahead * load * np.arange(ORDERS + 1))
    expected = (scaled * lines[0, 0] + load * lines[1, 0]) * turn
    # The ripple of the torque makes some more of the part that follows it.
    np.testing.assert_allclose(found[:, [2, 5]], expected[:, [2, 5]], rtol=0.02)


def test_the_chain_has_a_gauge_that_has_moved_see_the_same_later():
    """But for what comes of the torque's ripple, which is felt at all angles at once."""
    moved = Model(GEAR, (LIBRARY["gauge_position"](sensor=1, shift=0.05),))
    here, later = LAYOUT.lines(predict([Model(GEAR), moved], SITUATIONS, LAYOUT, sectors=40))[:, :, 2, 2]
    np.testing.assert_allclose(later, here * np.exp(-0.1j), rtol=1e-2)


def test_lines_of_a_gauge_that_was_dead_stay(of_form):
    _, deviating = of_form
    was, now = (replace(GEAR.gauges, gain=gain) for gain in ((0.0, 1, 1, 1, 1), (2.0,) * 5))
    dead = OwnLines(replace(deviating.own_lines, gauges=was), now)
    time = np.linspace(0, 0.1, 50)
    scene = Scene(time, 100 * time, 0 * time, POINTS[0], Conditions())
    found, one = dead.gauge(np.zeros((5, 50)), scene), replace(dead, gauges=was).gauge(np.zeros((5, 50)), scene)
    twice = replace(dead, gauges=replace(was, gain=(0.0, 2, 2, 2, 2)))
    np.testing.assert_allclose(found, twice.gauge(np.zeros((5, 50)), scene))
    np.testing.assert_allclose(found, [[1.0], [2], [2], [2], [2]] * one)


def test_a_filter_delays_the_deviation_of_its_gauge_too(of_form):
    features, deviating = of_form
    lag = 1e-4
    turned = np.outer([s.point.omega_in * lag for s in SITUATIONS], np.arange(ORDERS + 1))
    expected = LAYOUT.lines(features)
    expected[:, 2] /= 1 + 1j * turned
    found = with_and_without(deviating, LIBRARY["filter_mismatch"](sensor=1, lag=lag))
    np.testing.assert_allclose(found, expected, atol=1e-3 * np.abs(expected).max())


def test_a_flange_changes_nothing_of_what_the_structure_feels():
    """Only what a torque sensor shows: deviations of the maps follow the torque itself."""
    unit = Unit(Model(GEAR))
    alone, beside = (
        unit.left_open(Model(GEAR, effects), SITUATIONS, LAYOUT).columns
        for effects in ((), (LIBRARY["flange_gain"](share=0.05),))
    )
    assert alone.any()
    np.testing.assert_array_equal(beside, alone)
