"""What no known effect explains is described by its order, pattern and law; noise is not."""

from dataclasses import replace

import numpy as np
import pytest
from loop_fixtures import drawn, fitted_to, holding

from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.regularity import LAWS
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data.features import ORDERS, Layout
from swgsim.identification.search.regularities import Atom, atoms, columns, describe, other_laws, set_free

LAYOUT = Layout(("s1", "s2", "s3", "s4"))
AZIMUTH = np.pi / 2 * np.arange(4)


@pytest.fixture
def fitted():
    """Six recordings, noise of about 1."""
    return fitted_to(LAYOUT, np.random.default_rng(1), open_=3)


def travelling(fitted, order: int, waves: int, amplitude: float, theta: float) -> np.ndarray:
    """Rows of amplitude T / 70 N m cos(order phi - waves beta - theta) at the positions beta of the gauges."""
    lines = np.zeros((len(fitted.measured.situations), 4, ORDERS + 1), complex)
    for i, situation in enumerate(fitted.measured.situations):
        size = amplitude * situation.point.T_out / FULL_LOAD
        lines[i, :, order] = size * np.exp(-1j * (waves * AZIMUTH + theta))
    return fitted.measured.rows(LAYOUT.vector(lines))


@pytest.mark.parametrize(
    ("waves", "pattern"),
    [
        (0, "the same in s1 to s4"),
        (1, "one wave that turns with the wave generator (or three against it)"),
        (2, "opposite in neighbours (two waves)"),
        # Four gauges a quarter turn apart cannot tell three waves from one that turns the other way.
        (3, "one wave that turns against the wave generator (or three with it)"),
    ],
)
def test_a_travelling_pattern_of_order_3_in_proportion_to_the_load(fitted, waves, pattern):
    residual = travelling(fitted, 3, waves, 8.0, 0.7) + drawn(fitted.whole, np.random.default_rng(2))
    best = describe(holding(fitted, residual))[0]
    assert best.atom == Atom(3, pattern, "proportional to the load")
    assert best.amplitude == pytest.approx(8, abs=2)
    assert f"order 3, {pattern}, proportional to the load, amplitude " in str(best)


def test_an_offset_in_one_gauge(fitted):
    lines = np.zeros((4, ORDERS + 1), complex)
    lines[2, 0] = -6.0
    constant = np.broadcast_to(LAYOUT.vector(lines), (len(fitted.measured.situations), len(LAYOUT)))
    residual = fitted.measured.rows(constant) + drawn(fitted.whole, np.random.default_rng(4))
    best = describe(holding(fitted, residual))[0]
    assert best.atom == Atom(0, "in s3 alone", "constant")
    assert best.amplitude == pytest.approx(6, abs=2)
    assert best.phase == pytest.approx(np.pi)


def test_laws_that_the_operating_points_do_not_tell_apart_are_rivals(fitted):
    """At one load all laws of the load are one; at three they are told apart."""
    one_load = fitted_to(LAYOUT, np.random.default_rng(1), points=[OperatingPoint(n, 39.0) for n in (2000.0, 4000.0)])
    of_load = {"constant", *(law for law in LAWS if law.endswith("of the load") or law.endswith("to the load"))}
    for now, laws in ((fitted, {"proportional to the load"}), (one_load, of_load)):
        residual = travelling(now, 3, 0, 50.0, 0.7) + drawn(now.whole, np.random.default_rng(8))
        first, *others = describe(holding(now, residual))
        best = replace(first, rivals=other_laws(first, others))
        assert {best.atom.law, *best.rivals} == laws
        assert all(law in str(best) for law in best.rivals)


def test_phase_is_that_of_the_cosine(fitted):
    """The convention of the library: size cos(order phi - phase)."""
    residual = travelling(fitted, 3, 0, 50.0, 0.7)
    best = describe(holding(fitted, residual))[0]
    assert np.angle(np.exp(1j * (best.phase - 0.7))) == pytest.approx(0, abs=0.1)


def test_columns_of_an_atom_span_its_phases(fitted):
    span = columns(
        Atom(5, "one wave that turns with the wave generator (or three against it)", "proportional to the load"), fitted
    )
    one = travelling(fitted, 5, 1, 1.0, 1.1)
    left = one - span @ np.linalg.lstsq(span, one, rcond=None)[0]
    assert np.abs(left).max() < 1e-12


def test_a_regularity_that_is_set_free_is_gone(fitted):
    now = holding(fitted, travelling(fitted, 3, 0, 50.0, 0.7) + drawn(fitted.whole, np.random.default_rng(7)))
    best = describe(now)[0]
    free = set_free(now, best)
    assert best.gain > 1000
    assert next(each for each in describe(free) if each.atom == best.atom).gain < 20
    assert free.log_likelihood > now.log_likelihood + 400


def test_only_what_the_channels_can_show_is_tried():
    patterns = {atom.pattern for atom in atoms(LAYOUT)}
    assert "in s1 alone" in patterns
    assert not patterns & {"in s0 alone", "in T_in alone", "the same in all gauges"}


def test_what_an_atom_explains_is_a_fit_to_all_rows(fitted):
    """Which asks order by order, by the precision of their rows."""
    residual = drawn(fitted.whole, np.random.default_rng(7))
    asked = holding(fitted, residual)
    white = fitted.whole.whiten(residual)
    for described in describe(asked)[::50]:
        C = fitted.whole.whiten(columns(described.atom, fitted))
        explained = C @ np.linalg.lstsq(C, white)[0]
        assert described.gain == pytest.approx(explained @ explained, rel=1e-6, abs=1e-8)


def test_noise_is_drawn_as_it_is_declared(fitted):
    """Weighed by the inverse of its covariance it has that inverse as its covariance."""
    rows = np.arange(len(fitted.residual)) < 30
    drawn_ = next(fitted.null(8_000, np.random.default_rng(8)))[rows]
    expected = fitted.whole.precision(rows)
    scale = np.sqrt(np.diag(expected))
    np.testing.assert_allclose(
        drawn_ @ drawn_.T / 8_000 / np.outer(scale, scale), expected / np.outer(scale, scale), atol=0.05
    )
