"""Lines of a healthy gear that the model misses, and what commissioning leaves open."""

from dataclasses import replace

import numpy as np
import pytest
from loop_fixtures import fitted_to

from swgsim.identification.commissioning.lack_of_fit import (
    FALSE_DISCOVERIES,
    UNEXPLAINED_SHARE,
    lack_of_fit,
    require_own,
)
from swgsim.identification.commissioning.relinearisation import posterior, triangular_factor
from swgsim.identification.data.features import Layout
from swgsim.identification.data.measured import Measured

LAYOUT = Layout(("T_out", "s0", "s1", "s2"))
REPEATS = 3


@pytest.fixture(scope="module")
def measured() -> Measured:
    """Three repeats of six operating points, of a ripple of 100 in units of the noise."""
    fitted = fitted_to(LAYOUT, np.random.default_rng(1), repeats=REPEATS)
    ripple = 100 * (LAYOUT.order == 2) * np.ones((len(fitted.measured), 1))
    return Measured(fitted.measured.recordings, LAYOUT, ripple, np.ones(ripple.shape))


def line(channel: str, order: int) -> np.ndarray:
    return (LAYOUT.channel == channel) & (LAYOUT.order == order)


def test_noise_is_rarely_taken_for_something_missed(measured):
    """Of all lines together."""
    rng = np.random.default_rng(2)
    found = [lack_of_fit(measured, rng.standard_normal(measured.values.shape)).any() for _ in range(100)]
    assert np.mean(found) < 2.5 * FALSE_DISCOVERIES


@pytest.mark.parametrize("common", [True, False])
def test_what_is_missed_alike_in_repeats_or_in_all_recordings_is_found(measured, common):
    """And no other line."""
    rng = np.random.default_rng(3)
    points = [r.point for r in measured.recordings]
    off = {point: 1.0 if common else 2 * rng.choice([-1, 1]) for point in points}
    missed = rng.standard_normal(measured.values.shape)
    missed[:, line("T_out", 3)] += np.array([off[point] for point in points])[:, None]
    assert (lack_of_fit(measured, missed) == line("T_out", 3)).all()


def test_gauges_that_sit_alike_are_missed_alike(measured):
    missed = np.zeros(measured.values.shape)
    missed[:, line("s1", 4)] = 5.0
    found = lack_of_fit(measured, missed)
    assert found[line("s1", 4) | line("s2", 4)].all()
    assert not found[line("s0", 4)].any()


def test_a_channel_of_which_a_tenth_is_missed_is_refused(measured):
    missed = np.zeros(measured.values.shape)
    missed[:, line("s0", 1)] = 100 * 0.9 * UNEXPLAINED_SHARE
    require_own(measured, missed)
    missed[:, line("s0", 1)] = 100 * 1.1 * UNEXPLAINED_SHARE
    with pytest.raises(ValueError, match=r"leaves s0 \(11 %\) of the ripple unexplained, at most 10 %"):
        require_own(measured, missed)


def test_a_channel_without_ripple_is_not_refused_for_its_noise(measured):
    missed = np.random.default_rng(4).normal(0, 1.5, measured.values.shape)
    require_own(replace(measured, values=missed), missed)


def test_what_is_told_to_a_billionth_of_a_spread_has_a_root():
    """The inverse of its square is no covariance any more; a direction that nothing tells stays as it was."""
    fitted = fitted_to(LAYOUT, np.random.default_rng(5))
    open_ = np.hstack([1e9 * fitted.open, 0 * fitted.open[:, :1]])
    root, mean = posterior(replace(fitted, open=open_))
    covariance = root @ root.T
    white = fitted.errors.whiten(fitted.open)
    np.testing.assert_allclose(covariance[:-1, :-1] * 1e18, np.linalg.inv(white.T @ white), rtol=1e-6)
    assert covariance[-1, -1] == pytest.approx(1.0)
    assert mean == pytest.approx(0.0)
    part = triangular_factor(root[1:].T).T
    np.testing.assert_allclose(part @ part.T, covariance[1:, 1:], rtol=1e-9, atol=1e-30)
