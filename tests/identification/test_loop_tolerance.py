"""What the imperfect forms of effects leave open, and where a fit keeps it."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import Bump, Wave, fitted_to

from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.covariance.recording_covariance import RecordingCovariance
from swgsim.identification.covariance.scatter import Scatter
from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Model
from swgsim.identification.fit import form_error
from swgsim.identification.fit.priors import Declared, of_effects

LAYOUT = Layout(("T_in", "s0", "s1"))
STRONG = 10.0  # in units of the noise, feature by feature


@pytest.fixture
def fitted():
    return fitted_to(LAYOUT, np.random.default_rng(1), repeats=2)


def test_a_form_error_moves_every_line_and_no_size(fitted, monkeypatch):
    """Directions of a form error of 1: a line of a channel changes by its amplitude, in phase and out of phase."""
    shape = len(fitted.measured.situations), len(LAYOUT)
    whole = fitted.measured.rows(STRONG * np.random.default_rng(2).standard_normal(shape) * (LAYOUT.order == 2))
    monkeypatch.setattr(form_error, "signature", lambda fitted, number: whole)
    one = replace(fitted, calibrated=replace(fitted.calibrated, model=Model(GEAR, (Bump(1.0),))))
    assert form_error.form_directions(fitted) == []
    (D,) = form_error.form_directions(one)
    assert not D[np.tile(LAYOUT.order != 2, len(fitted.measured))].any()
    weighed = D / np.sqrt(fitted.errors.variance)[:, None]
    size = whole / np.sqrt(fitted.errors.variance)
    assert np.abs(size @ weighed).max() < 1e-6 * np.linalg.norm(size) * np.linalg.norm(weighed)
    lines = LAYOUT.lines(whole.reshape(fitted.measured.values.shape))
    quarter = LAYOUT.vector(1j * lines * (np.arange(3) == 1)[:, None]).ravel()
    left = quarter - D @ np.linalg.lstsq(D, quarter)[0]
    assert np.linalg.norm(left) < 0.05 * np.linalg.norm(quarter)
    spread = np.linalg.norm(D.T @ quarter) / np.linalg.norm(quarter) / np.linalg.norm(quarter)
    assert 0.9 < spread < 1.5


def test_a_size_and_a_phase_are_as_doubtful_as_imperfect_forms_would_make_them(fitted, monkeypatch):
    """By as much as parts of all sizes move the likeliest value; those of another effect move it too."""
    rng = np.random.default_rng(22)
    whole = fitted.measured.rows(STRONG * rng.standard_normal((len(fitted.measured.situations), len(LAYOUT))))
    J = STRONG * rng.standard_normal((len(fitted.measured.situations), len(LAYOUT), 3))
    model = Model(GEAR, (Wave(1.0, 0.5), Bump(1.0)))
    parameters = of_effects(model)
    held = replace(fitted, parameters=parameters, calibrated=replace(fitted.calibrated, model=model, J=J))
    other = fitted.measured.rows(J[..., 1]) * np.repeat(rng.uniform(0, 2, len(fitted.measured)), len(LAYOUT))
    monkeypatch.setattr(form_error, "signature", lambda fitted, number: (whole, other)[number])
    off = np.hstack([0.3 * form_error.parts(held, whole), 0.2 * form_error.parts(held, other)])
    likeliest = [held.whole.common_mean(off @ rng.standard_normal(off.shape[1]))[-3:] for _ in range(300)]
    spreads = [parameter.sd for parameter in parameters.values()]
    found = form_error.moved_by_forms(held, {0: 0.3, 1: 0.2})
    assert not any(form_error.moved_by_forms(held, {}).values())
    assert list(found) == ["wave 1: height", "wave 1: theta", "bump 2: height"]
    assert list(found.values()) == pytest.approx(np.std(likeliest, axis=0) * spreads, rel=0.15)


def test_what_is_open_of_the_unit_is_the_same_whatever_effects_leave_open(fitted):
    """It is set up once; the errors, the unit's, those of effects and parameters follow one another."""
    rng = np.random.default_rng(23)
    rows = len(fitted.residual)
    parameters = {name: Declared("-", 1.0, lambda model: 0.0, lambda model, to: model) for name in "ab"}
    J = rng.standard_normal((*fitted.calibrated.predicted.shape, 2))
    calibrated = replace(fitted.calibrated, position=dict.fromkeys(parameters, 0.0), J=J)
    fitted = replace(fitted, calibrated=calibrated, parameters=parameters)
    opened = fitted.allowing(rng.standard_normal((rows, 3))).allowing_forms(rng.standard_normal((rows, 2)))
    every = [fitted.errors.columns, fitted.open, opened.allowed.columns, opened.J]
    np.testing.assert_array_equal(opened.whole.columns, np.hstack(every))
    assert [each.shape[1] for each in (opened.closed.allowed.columns, opened.without_free.allowed.columns)] == [3, 2]
    for each, columns in ((opened, every), (opened.strict, [*every[:2], every[3]])):
        anew = Covariance(fitted.errors.alone, np.hstack(columns))
        assert each.log_likelihood == pytest.approx(anew.log_likelihood(fitted.from_start))
        block, _ = each.by_others[0]
        told = anew.left_out(fitted.from_start, [block])[0]
        np.testing.assert_allclose(each.nuisance[block], (anew.columns[:, :-2] @ told[:-2])[block])


def test_other_errors_of_single_recordings_are_those_it_would_have_been_given(fitted):
    def scattered(factor):
        moves = np.random.default_rng(5).standard_normal((*fitted.measured.values.shape, 2))
        scatter = Scatter({"load": factor, "speed": 2.0}, 6, 0.1 * np.eye(2))
        alone = RecordingCovariance(fitted.measured.variance, scatter.columns(moves))
        return replace(fitted, scatter=scatter, errors=replace(fitted.errors, base=alone))

    found, expected = scattered(1.0).scattering(scattered(7.0).scatter), scattered(7.0)
    assert found.scatter.sd == expected.scatter.sd
    np.testing.assert_allclose(found.errors.alone.C, expected.errors.alone.C)
