"""The low-rank algebra agrees with dense matrices."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import block_diag
from scipy.special import log_ndtr
from scipy.stats import multivariate_normal

from swgsim.common.chi2_logsf import log_tail
from swgsim.identification.covariance.low_rank_covariance import HIDDEN, Covariance, significant_columns
from swgsim.identification.covariance.recording_covariance import RecordingCovariance

SHAPES = {
    "recordings": st.integers(1, 4),
    "features": st.integers(2, 5),
    "kinds": st.integers(0, 6),
    "columns": st.integers(0, 15),
    "seed": st.integers(0, 10_000),
}


def random_covariance(
    recordings: int, features: int, kinds: int, columns: int, seed: int
) -> tuple[Covariance, np.ndarray, np.random.Generator]:
    """One with errors of every kind from a hundredth to a hundred times the noise, common ones given in up to three
    parts; and its dense form.
    """
    rng = np.random.default_rng(seed)
    noise = rng.uniform(0.1, 10, (recordings, features))
    C = rng.normal(size=(recordings, features, kinds)) * 10 ** rng.uniform(-2, 2, kinds)
    G = rng.normal(size=(recordings * features, columns)) * 10 ** rng.uniform(-2, 2, columns)
    dense = block_diag(*(np.diag(own) + each @ each.T for own, each in zip(noise, C, strict=True))) + G @ G.T
    first, second, third = np.split(G, np.sort(rng.integers(columns + 1, size=2)), axis=1)
    return Covariance(RecordingCovariance(noise, C), first).with_columns(second).with_columns(third), dense, rng


@settings(deadline=None, max_examples=60)
@given(**SHAPES)
def test_whitening_makes_the_covariance_the_identity(**shape):
    covariance, dense, rng = random_covariance(**shape)
    rows = len(dense)
    W = covariance.whiten(np.eye(rows))
    np.testing.assert_allclose(W @ dense @ W.T, np.eye(rows), atol=1e-7)
    x = rng.normal(size=(rows, 3))
    np.testing.assert_allclose(covariance.whiten(x), W @ x, atol=1e-8)
    np.testing.assert_allclose(covariance.whiten(x[:, 0]), W @ x[:, 0], atol=1e-8)


@settings(deadline=None, max_examples=60)
@given(**SHAPES)
def test_divergence_is_what_the_wrong_errors_cost_on_average(**shape):
    """The expected fall of the log-likelihood, per recording."""
    (one, *_), (other, *_) = (random_covariance(**shape | {"columns": 0, "seed": shape["seed"] + i}) for i in range(2))
    A, B = (np.diag(each.variance) + each.alone.dense @ each.alone.dense.T for each in (one, other))
    cost = (np.trace(np.linalg.solve(B, A)) - len(A) + np.linalg.slogdet(B)[1] - np.linalg.slogdet(A)[1]) / 2
    found = one.alone.divergence(other.alone)
    assert found == pytest.approx(cost / shape["recordings"], rel=1e-6, abs=1e-6)
    assert one.alone.divergence(one.alone) == pytest.approx(0, abs=1e-7)


@settings(deadline=None, max_examples=60)
@given(**SHAPES)
def test_whitening_is_symmetric_in_units_of_the_noise(**shape):
    covariance, dense, _ = random_covariance(**shape)
    rows = len(dense)
    scaled = np.array([covariance.whiten_in_place(each) for each in np.diag(np.sqrt(covariance.variance))])
    np.testing.assert_allclose(scaled, scaled.T, atol=1e-9)
    W = scaled.T / np.sqrt(covariance.variance)
    np.testing.assert_allclose(W @ dense @ W.T, np.eye(rows), atol=1e-7)


@settings(deadline=None, max_examples=60)
@given(**SHAPES)
def test_weighing_multiplies_by_the_inverse_of_the_covariance(**shape):
    covariance, dense, rng = random_covariance(**shape)
    rows = len(dense)
    inverse = np.linalg.inv(dense)
    np.testing.assert_allclose(covariance.weigh(np.eye(rows)), inverse, atol=1e-7)
    block = rng.random(rows) < 0.5
    np.testing.assert_allclose(covariance.precision(block), inverse[np.ix_(block, block)], atol=1e-7)


@settings(deadline=None, max_examples=60)
@given(**SHAPES)
def test_log_likelihood_is_the_normal_one_without_its_constant(**shape):
    covariance, dense, rng = random_covariance(**shape)
    rows = len(dense)
    r = rng.normal(size=rows)
    expected = multivariate_normal(np.zeros(rows), dense).logpdf(r) + 0.5 * rows * np.log(2 * np.pi)
    assert covariance.log_likelihood(r) == pytest.approx(expected, rel=1e-6, abs=1e-6)


@settings(deadline=None, max_examples=60)
@given(**SHAPES)
def test_rows_left_out_tell_nothing_of_the_common_errors(**shape):
    covariance, dense, rng = random_covariance(**shape)
    rows = len(dense)
    r = rng.normal(size=rows)
    others = rng.permutation(np.arange(rows) >= max(1, rows // 3))
    (found,) = covariance.left_out(r, [~others])
    expected = covariance.columns[others].T @ np.linalg.solve(dense[np.ix_(others, others)], r[others])
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-5)


@settings(deadline=None, max_examples=60)
@given(**SHAPES)
def test_common_errors_are_told_as_their_conditional_mean(**shape):
    covariance, dense, rng = random_covariance(**shape)
    rows = len(dense)
    r = rng.normal(size=rows)
    np.testing.assert_allclose(
        covariance.common_mean(r), covariance.columns.T @ np.linalg.solve(dense, r), rtol=1e-5, atol=1e-5
    )


@settings(deadline=None, max_examples=60)
@given(**SHAPES)
def test_errors_of_single_recordings_move_no_other_one(**shape):
    covariance, dense, rng = random_covariance(**shape)
    alone, by = covariance.alone, rng.normal(size=shape["recordings"] * shape["kinds"])
    np.testing.assert_allclose(alone.made(by), alone.dense @ by, atol=1e-9)
    np.testing.assert_allclose(
        alone.dense @ alone.dense.T + np.diag(covariance.variance) + covariance.columns @ covariance.columns.T,
        dense,
        atol=1e-7,
    )


@settings(deadline=None, max_examples=60)
@given(**SHAPES)
def test_what_noise_hides_is_hardly_any_variance(**shape):
    """Along every direction, in units of the noise."""
    covariance, _, _ = random_covariance(**shape)
    deviation = np.sqrt(covariance.variance)[:, None]
    fewer = significant_columns(covariance.columns, covariance.variance)
    dropped = (covariance.columns @ covariance.columns.T - fewer @ fewer.T) / deviation / deviation.T
    share = np.linalg.eigvalsh(dropped)
    rounding = 1e-12 * max(float(np.linalg.norm(covariance.columns / deviation) ** 2), 1.0)
    assert share.max() <= HIDDEN + rounding
    assert share.min() >= -rounding
    assert fewer.shape[1] <= min(covariance.columns.shape)


def test_columns_that_say_the_same_become_one():
    column = np.linspace(1, 2, 6)[:, None]
    fewer = significant_columns(np.hstack([3 * column, 4 * column, 1e-3 * np.eye(6)[:, :1]]), np.ones(6))
    assert fewer.shape == (6, 1)
    np.testing.assert_allclose(fewer @ fewer.T, 25 * column @ column.T, rtol=1e-5)


@pytest.mark.parametrize("value", [0.1, 3.0, 100.0, 599.0, 601.0, 2000.0, 1e6])
def test_tail_of_one_and_two_degrees_of_freedom_is_exact(value):
    assert float(log_tail(value, 2)) == pytest.approx(-value / 2, rel=1e-12)
    assert float(log_tail(value, 1)) == pytest.approx(np.log(2) + log_ndtr(-np.sqrt(value)), rel=1e-5)


@pytest.mark.parametrize("freedom", [4, 18, 72])
@pytest.mark.parametrize("value", [10.0, 700.0, 1100.0, 5000.0])
def test_tail_of_even_degrees_of_freedom_is_the_sum_of_poisson(freedom, value):
    terms = np.cumsum(np.log(np.concatenate([[1.0], value / 2 / np.arange(1, freedom // 2)])))
    expected = -value / 2 + np.logaddexp.reduce(terms)
    assert float(log_tail(value, freedom)) == pytest.approx(expected, abs=0.1)


def test_tail_falls_as_the_value_grows():
    values = np.linspace(1, 4000, 4000)
    for freedom in (1, 2, 8, 36, 90):
        assert np.all(np.diff(log_tail(values, freedom)) <= 1e-12)
