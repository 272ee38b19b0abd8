"""What every healthy gear does a little of, and how a session may be off."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import POINTS, recorded

from swgsim.gear.conditions import Conditions
from swgsim.identification.data.features import ORDERS, Layout
from swgsim.identification.data.measured import LEAST_EXPLAINED_VARIANCE, MOST_WANDER, OF_SESSION, WANDER, Measured
from swgsim.identification.data.model import Model, Situation
from swgsim.identification.fit import healthy_variability as healthy
from swgsim.identification.fit.priors import of_unit

LAYOUT = Layout(("T_in", "s0", "s1"))
NAMES = [name for name in OF_SESSION if "index" in name or name.partition(" of ")[2] in LAYOUT.channels]
ZEROS = [name for name in NAMES if name.startswith("zero of s")]
OTHERS = [name for name in NAMES if name not in ZEROS]
SITUATIONS = tuple(Situation(point, Conditions(25.0 + number, 600.0 * number)) for number, point in enumerate(POINTS))


@pytest.fixture
def predicted() -> np.ndarray:
    """Features of every situation."""
    return np.random.default_rng(1).normal(size=(len(SITUATIONS), len(LAYOUT)))


def of_s1(columns: np.ndarray) -> np.ndarray:
    """The columns of s1: lag, gain, zero, mean."""
    found = columns[..., LAYOUT.channel == "s1", 4:]
    assert not columns[..., LAYOUT.channel != "s1", 4:].any()
    return found


def test_a_lag_turns_every_order_of_one_gauge_by_the_angle_that_passes_meanwhile(predicted):
    lag = of_s1(healthy.of_gauges(predicted, SITUATIONS, LAYOUT))[..., 0]
    per_second = np.array([2 * np.pi / 60 * s.point.n_in_rpm for s in SITUATIONS])
    turn = np.exp(-1j * np.arange(ORDERS + 1) * per_second[:, None, None] * healthy.LAG / 100)
    late = LAYOUT.vector(LAYOUT.lines(predicted) * turn)[:, LAYOUT.channel == "s1"]
    np.testing.assert_allclose(lag / 100, late - predicted[:, LAYOUT.channel == "s1"], rtol=0.01, atol=1e-5)


def test_gain_and_zero_follow_the_temperature_and_the_mean_the_speed(predicted):
    _, gain, zero, mean = np.moveaxis(of_s1(healthy.of_gauges(predicted, SITUATIONS, LAYOUT)), -1, 0)
    warmer, own = np.arange(len(SITUATIONS))[:, None], LAYOUT.channel == "s1"
    np.testing.assert_allclose(gain, healthy.GAIN_PER_KELVIN * warmer * predicted[:, own])
    np.testing.assert_allclose(zero[:, 0], healthy.ZERO_PER_KELVIN * warmer[:, 0])
    assert not zero[:, 1:].any()
    assert not mean[:, 1:].any()
    assert mean[:, 0] / healthy.MEAN_AT_FULL_SPEED == pytest.approx([s.point.n_in_rpm / 4000 for s in SITUATIONS])


def test_friction_follows_the_temperature_by_as_much_as_declared():
    parameters, model = {name: of_unit(GEAR)[name] for name in ("mu", "b1", "b0")}, Model(GEAR)
    J = np.random.default_rng(2).normal(size=(len(SITUATIONS), len(LAYOUT), 3))
    found = healthy.of_friction(model, parameters, J, SITUATIONS)
    spreads = 5 * healthy.FRICTION_PER_KELVIN * GEAR.transmission.b1 / parameters["b1"].sd
    np.testing.assert_allclose(found[5, :, healthy.FRICTION.index("b1")], J[5, :, 1] * spreads)


def test_lines_of_the_drive_that_were_learned_follow_the_temperature_and_those_of_gauges_do_not():
    learned = np.zeros(len(LAYOUT))
    torque, gauge = (np.flatnonzero((LAYOUT.channel == name) & (LAYOUT.order == 2))[0] for name in ("T_in", "s1"))
    learned[[torque, gauge]] = 4.0
    found = healthy.of_learned(learned, SITUATIONS, LAYOUT)
    assert found.shape == (len(SITUATIONS), len(LAYOUT), 1)
    warmer = np.array([s.conditions.warmer for s in SITUATIONS])
    np.testing.assert_allclose(found[:, torque, 0], 4.0 * healthy.FRICTION_PER_KELVIN * warmer)
    assert not np.delete(found, torque, axis=1).any()


def silent(layout: Layout, values: np.ndarray) -> Measured:
    """Features of recordings of two sessions without any samples."""
    recordings = [
        replace(recorded({"phi_in": np.zeros(2)}, s.point, conditions=s.conditions), session=str(number % 2))
        for number, s in enumerate(SITUATIONS)
    ]
    return Measured(tuple(recordings), layout, values, np.ones(values.shape))


def test_an_error_of_the_angle_turns_what_was_recorded(predicted):
    turn = np.exp(1e-6j * np.arange(ORDERS + 1))
    turned = LAYOUT.vector(turn * LAYOUT.lines(predicted)) - predicted
    np.testing.assert_allclose(1e-6 * silent(LAYOUT, predicted).turning, turned, atol=1e-9)


def test_zeros_of_a_session_wander_as_a_random_walk_of_that_session(predicted):
    measured = silent(LAYOUT, predicted)
    mean = np.flatnonzero((LAYOUT.channel == "s1") & (LAYOUT.order == 0))[0]
    columns = measured.session_columns(predicted).reshape(*predicted.shape, -1)[:, mean]
    hours = np.array([r.conditions.elapsed / 3600 for r in measured.recordings])
    same = np.equal.outer(*2 * [[r.session for r in measured.recordings]])
    zero, drift = OF_SESSION["zero of s1"] ** 2, OF_SESSION["drift of s1"] ** 2 * np.outer(hours, hours)
    walk = WANDER**2 * np.minimum.outer(hours, hours)
    index = np.outer(measured.turning[:, mean], measured.turning[:, mean]) * OF_SESSION["index"] ** 2
    gain = np.outer(predicted[:, mean], predicted[:, mean]) * OF_SESSION["gain of s1"] ** 2
    found = columns @ columns.T - same * (zero + drift + gain + index)
    assert not found[~same].any()
    np.testing.assert_allclose(found, same * walk, atol=(1 - LEAST_EXPLAINED_VARIANCE) * WANDER**2 * hours.sum())
    assert (np.diag(found)[hours > 0] > 0).all()


def test_zeros_of_bridges_balanced_anew_lie_further_off_and_wander_a_little_more_and_nothing_else_does(predicted):
    measured = silent(LAYOUT, predicted)
    wide = replace(measured, zeros=16.0)
    columns, wider = (each.session_columns(predicted) for each in (measured, wide))
    others, zeros = 2 * len(OTHERS), 2 * len(ZEROS)
    walks = columns.shape[1] - others - zeros
    assert walks > 0
    np.testing.assert_allclose(wider, columns * np.repeat([1.0, 16.0, MOST_WANDER], [others, zeros, walks]))
    not_a_mean_of_a_gauge = np.tile((LAYOUT.order > 0) | (LAYOUT.channel == "T_in"), len(measured))
    assert not columns[not_a_mean_of_a_gauge, others:].any()
    assert wide.further("0", [], predicted[:0]).zeros == 16.0


def test_what_zeros_have_further_off_adds_up_with_what_they_have(predicted):
    measured = replace(silent(LAYOUT, predicted), zeros=2.0)
    now, wider = (each.session_columns(predicted) for each in (measured, replace(measured, zeros=8.0)))
    more = measured.further_zeros(8.0)
    np.testing.assert_allclose(now @ now.T + more @ more.T, wider @ wider.T, atol=1e-12)


def test_what_is_told_of_a_walk_holds_at_other_times_of_that_session(predicted):
    measured = silent(LAYOUT, predicted)
    mean = np.flatnonzero((LAYOUT.channel == "s1") & (LAYOUT.order == 0))[0]
    told = measured.session_columns(predicted).reshape(*predicted.shape, -1)[::2, mean]
    first = [r for r in measured.recordings if r.session == "0"]
    there = [Situation(r.point, r.conditions) for r in first]
    after = replace(there[-1], conditions=replace(there[-1].conditions, elapsed=there[-1].conditions.elapsed + 3600))
    further = measured.further("0", [*there, after], np.vstack([predicted[::2], predicted[-1:]]))
    found = further.session_columns(further.values, measured).reshape(*further.values.shape, -1)[:, mean]
    np.testing.assert_allclose(found[:-1], told, atol=1e-12)
    # From the last recording on, its zero is the best guess.
    zeros = slice(2 * len(OTHERS), None)
    np.testing.assert_allclose(found[-1, zeros], found[-2, zeros], atol=1e-12)
    assert np.ptp(found[:, zeros], axis=0).any()


def test_a_session_has_gains_and_drifts_of_its_own(predicted):
    measured = silent(LAYOUT, predicted)
    columns = measured.session_columns(predicted).reshape(*predicted.shape, -1)
    first = columns[..., : len(OTHERS)]
    assert not first[1::2].any()
    gain, drift = first[::2, :, OTHERS.index("gain of T_in")], first[::2, :, OTHERS.index("drift of s1")]
    np.testing.assert_allclose(gain, OF_SESSION["gain of T_in"] * predicted[::2] * (LAYOUT.channel == "T_in"))
    mean = np.flatnonzero((LAYOUT.channel == "s1") & (LAYOUT.order == 0))
    assert drift[:, mean[0]] == pytest.approx(OF_SESSION["drift of s1"] * np.array([0, 1 / 3, 2 / 3]))
    assert np.count_nonzero(drift) == 2
