"""Residuals of recordings with known order lines."""

import numpy as np
import pytest
from fabricated import of_lines

from learn.inputs.lines import ResidualLines
from learn.inputs.residuals import Accuracy, healthy_lines, leakage, residual
from swgsim.storage.orders import order_lines

LOADS = np.array([7.0, 20.0, 39.0, 70.0])
ORDERS = 6


def lines(seed, number=None):
    """Random lines (sample, sensor, order), or those of one recording; order 0 is real."""
    rng = np.random.default_rng(seed)
    shape = (5, ORDERS + 1) if number is None else (number, 5, ORDERS + 1)
    drawn = rng.standard_normal(shape) + 1j * rng.standard_normal(shape)
    drawn[..., 0] = drawn[..., 0].real
    return drawn


BASE, SLOPE = lines(0), 0.01 * lines(1)  # of a gear, over the load
K = np.arange(ORDERS + 1)
REVOLUTIONS = 2  # of the recordings that of_lines makes


def healthy_at(loads):
    return BASE + np.asarray(loads)[:, None, None] * SLOPE


def with_references(sample_lines, loads, references=None, reference_loads=LOADS):
    """Samples of one gear and the lines of its references, one at each load unless they are given."""
    references = healthy_at(reference_loads) if references is None else references
    is_reference = np.repeat([True, False], [len(references), len(sample_lines)])
    return of_lines(
        np.concatenate([references, sample_lines]),
        T_out_nm=np.append(reference_loads, loads),
        reference=is_reference,
        efficiency=np.where(is_reference, 0.7, 0.75),
    )


UNBOUNDED = Accuracy(load=1e4, angle=1e4, speed=1e4, line=1e-4)


def estimated(data, accuracy=UNBOUNDED, **options):
    return residual(healthy_lines([data], ORDERS, **options), accuracy)


def test_lines_and_slope_of_the_reference_are_found_at_every_load():
    found = healthy_lines([with_references(lines(2, 4), LOADS)], ORDERS)
    np.testing.assert_allclose(found.lines, lines(2, 4), atol=1e-12)
    np.testing.assert_allclose(found.reference, healthy_at(LOADS), atol=1e-12)
    np.testing.assert_allclose(found.slope, np.broadcast_to(SLOPE, found.slope.shape), atol=1e-12)
    assert found.eta_healthy.tolist() == [0.7] * 4


def test_errors_of_load_and_trigger_are_estimated_and_subtracted_at_every_load():
    load_error, angle_error = np.array([0.0, 0.5, -2.0, 3.0]), np.array([0.002, 0.0, -0.01, 0.03])
    turned = angle_error[:, None, None] * 1j * K * healthy_at(LOADS)
    remains, errors = estimated(with_references(healthy_at(LOADS) + load_error[:, None, None] * SLOPE + turned, LOADS))
    np.testing.assert_allclose(errors, np.column_stack([load_error, angle_error, np.zeros(4)]), atol=1e-10)
    np.testing.assert_allclose(remains, 0, atol=1e-10)


def test_the_residual_of_a_trigger_error_is_of_second_order():
    """The trigger's direction is the first order of exp(i k d): half the angle leaves a quarter."""
    angles = np.array([0.02, 0.01, 0.005])
    turned = np.exp(1j * K * angles[:, None, None]) * healthy_at([39.0] * 3)
    remains, errors = estimated(with_references(turned, [39.0] * 3))
    size = np.linalg.norm(remains, axis=(1, 2))
    np.testing.assert_allclose(size[:-1] / size[1:], 4, rtol=0.02)
    np.testing.assert_allclose(errors[:, 1], angles, rtol=0.01)


@pytest.mark.parametrize("revolutions", [2, 4])
def test_the_leakage_of_a_speed_error_is_correct_to_second_order(revolutions):
    angle = 2 * np.pi * revolutions * np.arange(600) / 600
    healthy = BASE[None]
    differences = []
    for error in (2e-3, 1e-3):
        signals = (healthy[..., None] * np.exp(1j * K[:, None] * (1 + error) * angle)).sum(axis=2).real
        changed = order_lines(signals, 60 * revolutions / 0.06, 10_000.0, ORDERS)
        differences.append(changed - healthy - error * leakage(healthy, np.array([revolutions])))
    size = [np.abs(each).max() for each in differences]
    assert size[0] < 0.1 * 2e-3 * np.abs(leakage(healthy, np.array([revolutions]))).max()
    assert size[0] / size[1] == pytest.approx(4, rel=0.3)


def test_errors_stay_within_the_prior_of_the_bench():
    """Where the fit is ill-conditioned, what else varies is not taken for an impossible error of the load."""
    noise = 1e-4 * lines(9, 50)
    data = with_references(healthy_at([39.0] * 50) + noise, [39.0] * 50)
    _, bounded = estimated(data, Accuracy())
    assert (np.abs(bounded).max(axis=0) < 3 * np.array([0.39, 0.005, 0.002])).all()
    rng = np.random.default_rng(10)
    load_error, angle_error = rng.normal(0, 0.3, 50), rng.normal(0, 0.005, 50)
    shifted = load_error[:, None, None] * SLOPE + angle_error[:, None, None] * 1j * K * healthy_at([39.0])
    _, found = estimated(with_references(healthy_at([39.0] * 50) + shifted + noise, [39.0] * 50), Accuracy())
    np.testing.assert_allclose(found[:, 0], load_error, atol=0.02)
    np.testing.assert_allclose(found[:, 1], angle_error, atol=1e-3)


def as_real(values):
    flat = values[..., 1:].ravel()
    return np.concatenate([flat.real, flat.imag])


def orthogonal_fault(healthy):
    """A random fault without its parts along the slope and the turned lines; its order 0 is free."""
    fault = lines(3)
    directions = np.stack([SLOPE, 1j * K * healthy, leakage(healthy[None], np.array([REVOLUTIONS]))[0]])
    share, *_ = np.linalg.lstsq(np.stack([as_real(each) for each in directions], axis=1), as_real(fault), rcond=None)
    return fault - np.tensordot(share, directions, axes=1)


def test_a_fault_orthogonal_to_the_errors_stays_in_the_residual():
    (healthy,) = healthy_at([39.0])
    fault = orthogonal_fault(healthy)
    sample = healthy + fault + 2.0 * SLOPE - 0.01 * 1j * K * healthy
    remains, errors = estimated(with_references(sample[None], [39.0]))
    np.testing.assert_allclose(errors, [[2.0, -0.01, 0.0]], atol=1e-9)
    np.testing.assert_allclose(remains[0], fault, atol=1e-9)


def test_a_single_load_has_no_slope_and_the_trigger_error_is_subtracted():
    (healthy,) = healthy_at([39.0])
    sample = healthy + 0.01 * 1j * K * healthy
    data = with_references(sample[None], [39.0], healthy[None], [39.0])
    np.testing.assert_array_equal(healthy_lines([data], ORDERS).slope, 0)
    remains, errors = estimated(data)
    np.testing.assert_allclose(errors, [[0.0, 0.01, 0.0]], atol=1e-11)
    np.testing.assert_allclose(remains, 0, atol=1e-11)


def test_offsets_do_not_affect_the_errors():
    sample = healthy_at(LOADS)
    sample[:, :, 0] += 5.0
    remains, errors = estimated(with_references(sample, LOADS))
    np.testing.assert_allclose(errors, 0, atol=1e-10)
    np.testing.assert_allclose(remains[:, :, 0], 5.0, atol=1e-10)


def test_only_the_first_acquisitions_of_the_reference_are_used():
    three = np.concatenate([healthy_at([39.0]) + shift for shift in (0.0, 0.3, 3.0)])
    data = with_references(healthy_at([39.0]), [39.0], three, [39.0] * 3)
    for number, shift in ((1, 0.0), (2, 0.15), (3, 1.1), (None, 1.1)):
        found = healthy_lines([data], ORDERS, number).reference
        np.testing.assert_allclose(found[..., 0], (healthy_at([39.0]) + shift)[..., 0], atol=1e-12)


def test_a_table_of_lines_is_the_residual_with_its_errors():
    data = with_references(lines(2, 4), LOADS)
    remains, errors = residual(healthy_lines([data], ORDERS))
    made = ResidualLines("lines", ORDERS).learning_set([data])
    column = dict(zip(made.names, made.features.T, strict=True))
    np.testing.assert_allclose(column["s2[0]"], remains[:, 2, 0].real, atol=1e-12)
    np.testing.assert_allclose(column["Re s4[3]"] + 1j * column["Im s4[3]"], remains[:, 4, 3], atol=1e-12)
    np.testing.assert_allclose(column["angle error"], errors[:, 1], atol=1e-12)
