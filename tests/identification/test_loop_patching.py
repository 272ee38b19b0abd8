"""A regularity joins the model where it holds at every operating point, and not by a law of its session."""

from dataclasses import replace

import numpy as np
import pytest
from loop_fixtures import drawn, fitted_to, holding
from swgsim.identification.decide.selection import Closed

from swgsim.effects.regularity import OF_TIME
from swgsim.identification.data.features import Layout
from swgsim.identification.decide import empirical_terms as patching
from swgsim.identification.fit.errors import Errors, of_points_left_out, rms
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.priors import Declared
from swgsim.identification.search.regularities import Atom, Described, columns

LAYOUT = Layout(("s1", "s2", "s3", "s4"))
ATOM = Atom(5, "in s2 alone", "constant")


@pytest.fixture
def fitted() -> Fitted:
    """Six operating points."""
    return fitted_to(LAYOUT, np.random.default_rng(1), open_=0)


@pytest.fixture(autouse=True)
def _fit(monkeypatch: pytest.MonkeyPatch) -> None:
    """A fit of the cosine and sine of the atom, which needs no chain."""

    def extended(now: Fitted, _: object) -> Fitted:
        J = 100 * columns(ATOM, now)
        weighed = J / now.errors.variance[:, None]
        told = np.linalg.solve(np.eye(J.shape[1]) + weighed.T @ J, weighed.T @ now.residual)
        shape = now.calibrated.predicted.shape
        position = dict(zip(("cosine", "sine"), told.tolist(), strict=True))
        predicted = now.calibrated.predicted + (J @ told).reshape(shape)
        calibrated = replace(now.calibrated, position=position, predicted=predicted, J=J.reshape(*shape, -1))
        amplitude = Declared("mV/V", 100.0, lambda _: 0.0, lambda model, _: model)
        return replace(now, parameters=dict.fromkeys(position, amplitude), calibrated=calibrated)

    monkeypatch.setattr(patching, "extended", extended)


def is_added(fitted: Fitted, shares: np.ndarray, rivals: tuple[str, ...] = ()) -> bool:
    """Whether the atom is, where every operating point has such a share of it in its noise."""
    held = np.sum([s * rows for s, rows in zip(shares, fitted.measured.point_rows(), strict=True)], axis=0)
    now = holding(fitted, 20 * held * columns(ATOM, fitted)[:, 0] + drawn(fitted.errors, np.random.default_rng(2)))
    described = Described(ATOM, 1000.0, 2, 20.0, 0.0, 0.001, rivals)
    closed = Closed(now, now, now, (), (), (), (), None, unknown=(described,))
    return patching.patched(closed).after is not now


def test_one_that_holds_everywhere_is_added(fitted: Fitted) -> None:
    assert is_added(fitted, np.ones(6))


def test_one_that_does_not_hold_at_one_operating_point_is_not(fitted: Fitted, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patching, "of_points_left_out", lambda _: np.ones(6))  # which would refuse it too
    assert not is_added(fitted, np.array([1.0, 1, 1, 0, 1, 1]))


def test_one_that_may_as_well_follow_the_time_is_not(fitted: Fitted) -> None:
    assert not is_added(fitted, np.ones(6), rivals=(OF_TIME,))


@pytest.mark.parametrize(
    ("rivals", "taken"),
    [
        ((), "with the square of the load"),
        (("with the root of the load", "proportional to the load"), "proportional to the load"),
    ],
)
def test_of_laws_that_explain_it_as_well_the_simplest_is_taken(
    fitted: Fitted, monkeypatch: pytest.MonkeyPatch, rivals: tuple[str, ...], taken: str
) -> None:
    given = []
    monkeypatch.setattr(patching, "extended", lambda now, added: given.extend(added) or now)
    curved = Described(replace(ATOM, law="with the square of the load"), 1000.0, 2, 20.0, 0.0, 0.001, rivals)
    patching.patched(Closed(fitted, fitted, fitted, (), (), (), (), None, unknown=(curved,)))
    assert [effect.law for effect in given] == [taken]


def test_noise_is_not(fitted: Fitted) -> None:
    assert not is_added(fitted, np.zeros(6))


def test_error_of_a_point_left_out_is_that_of_what_the_others_tell(fitted: Fitted) -> None:
    """What one point alone shows is predicted as nothing there, and as something where it is not."""
    shown = 50 * fitted.measured.point_rows()[2] * columns(ATOM, fitted)[:, 0]
    before = holding(replace(fitted, errors=replace(fitted.errors, G=fitted.errors.G[:, :0])), shown)
    after = patching.extended(before, ())
    missed, before_it = of_points_left_out(after), of_points_left_out(before)
    assert missed[2] == pytest.approx(before_it[2])
    assert np.delete(missed, 2).min() > 0.1 * missed[2]
    np.testing.assert_array_equal(np.delete(before_it, 2), 0)


def test_what_a_whole_session_has_off_is_no_error_of_the_model(fitted: Fitted) -> None:
    """It is told by the other operating points of the session; noise stays."""
    zero = np.tile(LAYOUT.order == 0, len(fitted.measured)).astype(float)[:, None]
    noise = np.sqrt(fitted.errors.variance) * np.random.default_rng(3).standard_normal(len(zero))
    off = replace(fitted, errors=replace(fitted.errors, G=100 * zero))
    found, quiet = (Errors(held, held) for held in (holding(off, noise + 150 * zero[:, 0]), holding(off, noise)))
    np.testing.assert_allclose(found.fit, quiet.fit, rtol=1e-2)
    np.testing.assert_allclose(found.heldout, quiet.heldout, rtol=1e-2)
    np.testing.assert_array_less(found.heldout, 10)


def test_what_a_model_lacks_is_an_error_though_a_nuisance_could_hide_it(fitted: Fitted) -> None:
    """The best model says how much of it is nuisance; by itself, the model before would call it nothing else."""
    line = columns(ATOM, fitted)[:, :1]
    before = holding(replace(fitted, errors=replace(fitted.errors, G=30 * line)), 50 * line[:, 0])
    best = patching.extended(before, ())
    shown = of_s2(Errors(holding(before, 50 * line[:, 0]), holding(best, 0 * line[:, 0])).fit)
    assert of_s2(Errors(before, before).heldout) < 0.05 * shown
    assert of_s2(Errors(before, best).heldout) == pytest.approx(shown, rel=0.15)
    assert of_s2(Errors(best, best).heldout) < 0.05 * shown


def of_s2(error: np.ndarray) -> float:
    """Of all recordings."""
    return rms(error[:, LAYOUT.channels.index("s2")])
