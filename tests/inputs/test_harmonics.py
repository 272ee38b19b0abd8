"""Harmonics are invariant under the symmetries of the gear, and depend on faults."""

from dataclasses import replace

import numpy as np
import pytest
from fabricated import of_lines, recordings

from learn.inputs.harmonics import RIPPLE_ORDERS, SMALLEST_RIPPLE, Harmonics
from learn.inputs.residuals import healthy_lines, residual

ORDERS = 8
K = np.arange(ORDERS + 1)
QUARTER = np.exp(-0.5j * np.pi * K)  # the waveform a quarter of a revolution later
HARMONICS = Harmonics("harmonics", ORDERS)


@pytest.fixture
def nothing_taken_out(monkeypatch):
    """Replace the residual by the difference to the reference, as fitted errors do not share the symmetry of faults."""

    def difference(healthy):
        return healthy.lines - healthy.reference, np.zeros((len(healthy.lines), 3))

    monkeypatch.setattr("learn.inputs.lines.residual", difference)


def drawn(*shape, seed):
    rng = np.random.default_rng(seed)
    lines = rng.standard_normal((*shape, ORDERS + 1)) + 1j * rng.standard_normal((*shape, ORDERS + 1))
    lines[..., 0] = lines[..., 0].real
    return lines


def symmetric(seed):
    """Lines of a gear whose gauges s1 to s4 see the same waveform, each a quarter of a revolution after the last."""
    torque, waveform = drawn(2, seed=seed)
    torque[np.setdiff1d(K, [0, *RIPPLE_ORDERS])] = 0
    return np.concatenate([torque[None], waveform * QUARTER ** np.arange(4)[:, None]])


def turned(fault):
    """A fault a quarter turn further around the flex spline: the next gauge sees it, a quarter revolution later."""
    return np.concatenate([fault[:1], np.roll(fault[1:], 1, axis=0) * QUARTER])


def features(fault, healthy, slope=0.0):
    """Features by name of one recording with a fault, beside references at two loads."""
    data = of_lines(
        np.stack([healthy, healthy + 31.0 * slope, healthy + fault]), T_out_nm=[39.0, 70.0, 39.0], variant=[0, 1, 2],
        reference=[True, True, False],
    )  # fmt: skip
    made = HARMONICS.learning_set([data])
    return dict(zip(made.names, made.features[0], strict=True))


def test_a_crack_a_quarter_turn_further_has_the_same_magnitudes(nothing_taken_out):
    healthy, slope, crack = symmetric(0), 0.01 * symmetric(1), drawn(5, seed=2)
    crack[0] = 0  # its part in the torque does not turn
    before, after = (features(fault, healthy, slope) for fault in (crack, turned(crack)))
    magnitudes = [name for name in before if name.startswith("|")]
    assert len(magnitudes) == 4 * (ORDERS // 2 + 1)
    assert min(before[name] for name in magnitudes) > 0.01
    for name in (*magnitudes, "load error", "angle error"):
        assert after[name] == pytest.approx(before[name], abs=1e-10), name
    assert abs(after["s1[0]"] - before["s1[0]"]) > 0.1  # while the gauges themselves tell where the crack is


def test_magnitudes_are_those_of_waves_around_the_circumference():
    fault = np.zeros((5, ORDERS + 1), dtype=complex)
    gauge = np.arange(4)
    fault[1:, 2] = 0.3 * np.exp(0.7j + 2j * np.pi * gauge / 4)  # wave number 1
    fault[1:, 6] = 0.2 * (-1.0) ** gauge  # wave number 2
    found = features(fault, np.zeros((5, ORDERS + 1), dtype=complex))
    for name, value in found.items():
        if name.startswith("|"):
            expected = {"|s1..s4[2]| wave 1": 0.3, "|s1..s4[6]| wave 2": 0.2}.get(name, 0.0)
            assert value == pytest.approx(expected, abs=1e-12), name


def rippled(factors, healthy, fault):
    """Ripple of another size and phase, in the torque bridge and in what s1 to s4 have in common, healthy or not."""

    def changed(lines):
        lines = lines.copy()
        for order, factor in zip(RIPPLE_ORDERS, factors, strict=True):
            lines[0, order] *= factor
            common = lines[1:, order].mean()
            lines[1:, order] += (factor - 1) * common
        return lines

    return features(changed(fault), changed(healthy))


def split_by_kind(found):
    relative = {name: value for name, value in found.items() if "/ healthy" in name}
    absolute = {name: value for name, value in found.items() if "s0[" in name and name not in relative}
    return relative, absolute


def in_common(seed):
    """Lines whose gauges s1 to s4 are equal."""
    lines = drawn(2, seed=seed)
    return np.concatenate([lines[:1], np.repeat(lines[1:], 4, axis=0)])


def test_a_ripple_of_another_phase_gives_the_same_relative_features(nothing_taken_out):
    healthy, fault = in_common(3), 0.1 * in_common(4)
    before, after = (rippled(factors, healthy, fault) for factors in ((1, 1, 1), np.exp([0.5j, 2j, -1j])))
    for (name, one), other in zip(split_by_kind(before)[0].items(), split_by_kind(after)[0].values(), strict=True):
        assert other == pytest.approx(one, abs=1e-10), name
    assert abs(after["Re s0[2]"] - before["Re s0[2]"]) > 0.01


def test_stiffness_scales_a_ripple_of_any_size_and_phase_by_the_same_factor(nothing_taken_out):
    healthy = in_common(5)
    before, after = (
        rippled(factors, healthy, -0.2 * healthy) for factors in ((1, 1, 1), (0.3, 2.0 * np.exp(1j), 0.1j))
    )
    relative, absolute = split_by_kind(before)
    assert len(relative) == 4 * len(RIPPLE_ORDERS)
    for order in RIPPLE_ORDERS:
        assert relative[f"Re s0[{order}] / healthy"] == pytest.approx(-0.2)
        assert relative[f"Im s0[{order}] / healthy"] == pytest.approx(0, abs=1e-10)
    for name, value in relative.items():
        assert after[name] == pytest.approx(value, abs=1e-10), name
    assert any(abs(after[name] - value) > 0.01 for name, value in absolute.items())


@pytest.mark.parametrize("healthy_ripple", [0.0, 1e-9j])
def test_a_healthy_ripple_that_vanishes_bounds_the_relative_features(healthy_ripple):
    healthy, fault = np.zeros((2, 5, ORDERS + 1), dtype=complex)
    healthy[0, 2], fault[0, 2] = healthy_ripple, 1e-3j
    found = features(fault, healthy)
    size = np.hypot(found["Re s0[2] / healthy"], found["Im s0[2] / healthy"])
    assert size == pytest.approx(1e-3 / SMALLEST_RIPPLE, rel=1e-3)


def test_columns_are_those_of_the_residual():
    data = recordings(gears=2, variants=2, disturbance=0.01)
    made = HARMONICS.learning_set([data])
    column = dict(zip(made.names, made.features.T, strict=True))
    lines, errors = residual(healthy_lines([data], ORDERS))
    np.testing.assert_array_equal(column["s3[0]"], lines[:, 3, 0].real)
    np.testing.assert_array_equal(column["Im s0[4]"], lines[:, 0, 4].imag)
    np.testing.assert_array_equal(column["angle error"], errors[:, 1])
    assert "log eta_rel" in column
    bare = replace(HARMONICS, efficiency=False, operating_point=False)
    assert set(column) - set(bare.learning_set([data]).names) == {
        "log eta_rel", "root of log eta_rel", "viscous loss", "speed", "load", "temperature",
    }  # fmt: skip
