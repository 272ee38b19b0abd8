"""Orders above those that the model is compared at: what is there is told, what is known is not."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import POINTS, recorded, turning

from swgsim.effects.regularity import Regularity
from swgsim.identification.data.model import Model
from swgsim.identification.search.high_orders import high_order_regularities, residual_lines
from swgsim.storage.labelled_signals import SENSORS

pytestmark = pytest.mark.end_to_end
MODEL, NOISE, LEVEL, RATE = Model(GEAR), 1e-3, 0.005, 10_000.0


def bench(rng, add=lambda phi, point: {}, points=POINTS, repeats=3, rate=RATE, noise=NOISE):
    """Gauges of noise, with what is added to some of them at an operating point."""
    found = []
    for point in points:
        for _ in range(repeats):
            phi = turning(point, 12, rate)
            more = add(phi, point)
            gauges = {name: rng.normal(0, noise, len(phi)) + more.get(name, 0.0) for name in SENSORS}
            found.append(recorded({"phi_in": phi, **gauges}, point, rate))
    return found


def coupling(size):
    """Order 13 in proportion to the load, opposite in s1 and s3."""

    def add(phi, point):
        wave = size * point.T_out / 70 * np.cos(13 * phi - 0.5)
        return {"s1": wave, "s3": -wave}

    return add


def test_a_coupling_of_13_teeth_has_its_order_pattern_law_amplitude_and_phase():
    found = high_order_regularities(bench(np.random.default_rng(1), coupling(5e-3)), (), MODEL, MODEL, LEVEL, 3)
    assert [(each.atom.order, each.atom.pattern, each.atom.law) for each in found] == [
        (13, "opposite in s1 and s3", "proportional to the load")
    ]
    assert found[0].amplitude == pytest.approx(5e-3, rel=0.05)
    assert found[0].phase == pytest.approx(0.5, abs=0.05)
    assert isinstance(found[0].effect, Regularity)


def test_what_the_healthy_gear_has_is_not_missing():
    rng = np.random.default_rng(2)
    asked, healthy = bench(rng, coupling(5e-3)), bench(rng, coupling(5e-3))
    assert high_order_regularities(asked, healthy, MODEL, MODEL, LEVEL, 3) == ()
    grown = bench(rng, coupling(15e-3))
    assert high_order_regularities(grown, healthy, MODEL, MODEL, LEVEL, 3)[0].amplitude == pytest.approx(10e-3, rel=0.1)


def ringing(rng):
    """Noise of a mode with two waves around the flex spline, ten times the smooth one, at order 13 of 2000 rpm."""

    def add(phi, point):
        if point.n_in_rpm != 2000:
            return {}
        cosine, sine = rng.normal(0, 10 * NOISE * np.sqrt(2 / len(phi)), 2)
        wave = cosine * np.cos(13 * phi) + sine * np.sin(13 * phi)
        return {"s1": wave, "s2": -wave, "s3": wave, "s4": -wave}

    return add


def test_lines_in_a_narrow_band_are_as_uncertain_as_their_pattern():
    """Which the gauges have together: with independent gauges, its mean square would be 4."""
    rng = np.random.default_rng(5)
    asked, healthy = bench(rng, ringing(rng), repeats=6), bench(rng, ringing(rng), repeats=6)
    lines = residual_lines(asked, healthy, MODEL, MODEL).lines[:2, 1:, : len(asked)]
    rung = [each.point.n_in_rpm == 2000 for each in asked]
    in_pattern = np.tensordot([0.5, -0.5, 0.5, -0.5], lines[..., rung], (0, 1))
    square = (np.abs(in_pattern) ** 2).mean(axis=-1) / 2
    # The healthy gear's laws take three of eighteen complex numbers, and 36 numbers are good to 24 %.
    assert square == pytest.approx([1, 1], abs=0.6)


def test_a_bench_that_is_noisier_than_in_commissioning_shows_nothing_new():
    rng = np.random.default_rng(6)
    sessions = [(bench(rng, repeats=1, noise=3 * NOISE), bench(rng)) for _ in range(10)]
    assert not any(high_order_regularities(*each, MODEL, MODEL, LEVEL, 3) for each in sessions)


def test_an_index_that_is_off_is_no_new_line():
    rng = np.random.default_rng(3)
    healthy = bench(rng, coupling(5e-3))
    turned = [replace(each, channels={**each.channels, "phi_in": each.channels["phi_in"] + 0.02}) for each in healthy]
    assert high_order_regularities(turned, healthy, MODEL, MODEL, LEVEL, 3) == ()


def test_what_was_found_explains_its_high_orders():
    stray = Regularity(20, 5e-3, 0.3, "in s2 alone", "constant")
    asked = bench(np.random.default_rng(4), lambda phi, point: {"s2": 5e-3 * np.cos(20 * phi - 0.3)})
    assert [each.effect.order for each in high_order_regularities(asked, (), MODEL, MODEL, LEVEL, 3)] == [20]
    assert high_order_regularities(asked, (), MODEL, MODEL.plus(stray), LEVEL, 3) == ()


def test_what_was_found_may_be_sharper_than_the_library_has_it():
    """A tenth of its line is within its form, in the gauge that has it."""
    known = Regularity(2, 50e-3, 0.0, "in s2 alone", "constant")

    def sharper(phi, point):
        return {"s2": 50e-3 * np.cos(2 * phi) + 5e-3 * np.cos(14 * phi)}

    asked = bench(np.random.default_rng(8), sharper)
    assert high_order_regularities(asked, (), MODEL, MODEL.plus(known), LEVEL, 3) == ()
    moved = [replace(each, channels={**each.channels, "s3": each.channels["s2"]}) for each in asked]
    assert [each.atom.pattern for each in high_order_regularities(moved, (), MODEL, MODEL.plus(known), LEVEL, 3)] == [
        "in s3 alone"
    ]


@pytest.mark.slow
def test_noise_is_nothing():
    told = [
        high_order_regularities(bench(np.random.default_rng([5, n]), repeats=1), (), MODEL, MODEL, 0.1, 3)
        for n in range(40)
    ]
    # 4 of 40 are expected; more than 9 in one of a hundred.
    assert sum(map(bool, told)) <= 9


def test_another_phase_in_every_recording_is_no_regularity():
    rng = np.random.default_rng(6)

    def hum(phi, point):
        return {"s1": 2e-3 * np.cos(14 * phi + rng.uniform(0, 2 * np.pi))}

    assert high_order_regularities(bench(rng, hum), (), MODEL, MODEL, LEVEL, 3) == ()
