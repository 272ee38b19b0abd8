"""Errors of what was fitted and of what was left out, the noise floor, and how sure each of them is."""

from dataclasses import replace

import numpy as np
import pytest
from loop_fixtures import POINTS, drawn, fitted_to, holding

from swgsim.identification.data.features import Layout
from swgsim.identification.fit.errors import Errors, noise_floor, repeat_noise, rms
from swgsim.identification.fit.priors import Declared
from swgsim.identification.report.prediction_errors import FEWEST_POINTS, WHAT, _explained, _of_floor, _ratio, error
from swgsim.identification.search.regularities import Atom, columns

LAYOUT = Layout(("s1", "s2"))
ATOM = Atom(5, "in s2 alone", "constant")


def fitted(points=POINTS, repeats=3, open_=0):
    return fitted_to(LAYOUT, np.random.default_rng(1), points=points, repeats=repeats, open_=open_)


def in_recording(number, now):
    """Rows of a recording, as ones."""
    return np.repeat(np.arange(len(now.measured)) == number, len(LAYOUT)).astype(float)


def test_what_one_recording_alone_shows_is_an_error_of_that_recording():
    now = fitted()
    one = holding(replace(now, errors=replace(now.errors, G=now.errors.G[:, :0])), 50 * in_recording(4, now))
    found = Errors(one, one).repeats.sum(axis=1)
    assert np.flatnonzero(found > 1e-9).tolist() == [4]


@pytest.mark.parametrize("points", [POINTS, POINTS[:1]], ids=["six points", "one point"])
def test_what_a_session_has_off_is_told_by_the_other_repeats(points):
    """Also where there is one operating point only, so that none can be left out."""
    now = fitted(points)
    zero = np.tile(LAYOUT.order == 0, len(now.measured)).astype(float)[:, None]
    noise = np.sqrt(now.errors.variance) * np.random.default_rng(3).standard_normal(len(zero))
    off = replace(now, errors=replace(now.errors, G=100 * zero))
    found, quiet = (
        Errors(held, held).repeats for held in (holding(off, noise + 150 * zero[:, 0]), holding(off, noise))
    )
    np.testing.assert_allclose(found, quiet, atol=0.01)
    assert rms(found) < 10
    assert np.isnan(Errors(off, off).heldout).all() == (len(points) == 1)


def test_recordings_without_a_repeat_have_no_error_of_repeats():
    now = fitted(repeats=2)
    recordings = (*now.measured.recordings[:-1], replace(now.measured.recordings[-1], session="2"))
    now = holding(
        replace(now, measured=replace(now.measured, recordings=recordings)), drawn(now.errors, np.random.default_rng(2))
    )
    known = np.isfinite(Errors(now, now).repeats).all(axis=1)
    assert np.flatnonzero(~known).tolist() == [10, 11]  # the last one, and the one that it had been a repeat of
    assert np.isnan(Errors(*2 * [fitted(repeats=1)]).repeats).all()


def test_noise_floor_is_the_noise():
    now = fitted(repeats=20)
    held = holding(now, np.sqrt(now.errors.variance) * np.random.default_rng(4).standard_normal(len(now.residual)))
    quiet = Errors(held, held)
    np.testing.assert_allclose(noise_floor(held.measured), np.sqrt((quiet.fit**2).mean(axis=0)), rtol=0.1)
    assert repeat_noise(fitted(repeats=1).measured) is None
    assert np.isnan(noise_floor(fitted(repeats=1).measured)).all()


def test_interval_of_the_floor_holds_it_in_95_of_100_cases():
    """By so many spare recordings, the errors of each of which go together."""
    rng, spare = np.random.default_rng(5), 12
    floors = np.sqrt(rng.chisquare(spare, 2000) / spare)
    held = [low < 1 < high for low, high in (_of_floor(float(floor), spare) for floor in floors)]
    assert np.mean(held) == pytest.approx(0.95, abs=4 * np.sqrt(0.05 * 0.95 / 2000))


def test_ratio_has_an_interval_where_operating_points_differ():
    rng = np.random.default_rng(6)
    points = np.repeat(np.arange(6), 3)
    before = np.ones((18, 2))
    same = _ratio(0.2 * before, before, points)
    assert same["value"] == pytest.approx(0.2)
    np.testing.assert_allclose(same["ci95"], 0.2)
    apart = _ratio(before * rng.uniform(0.1, 0.4, 6)[points, None], before, points)
    low, high = apart["ci95"]
    assert 0.1 < low < apart["value"] < high < 0.4


def test_ratio_has_no_interval_of_a_few_points_nor_where_nothing_was_added():
    before = np.ones((FEWEST_POINTS - 1, 2))
    assert _ratio(0.2 * before, before, np.arange(FEWEST_POINTS - 1)) == {"value": pytest.approx(0.2), "ci95": None}
    before = np.ones((6, 2))
    assert _ratio(before, before, np.arange(6)) == {"value": 1.0, "ci95": None}
    assert _ratio(np.nan * before, np.nan * before, np.arange(6)) == {"value": None, "ci95": None}


def test_share_explained():
    assert _explained(5.0, 1.0, 1.0, [0.8, 1.3]) == pytest.approx(1.0)
    assert _explained(5.0, 3.0, 1.0, [0.8, 1.3]) == pytest.approx(16 / 24)
    assert _explained(1.2, 0.9, 1.0, [0.8, 1.3]) is None
    assert _explained(5.0, 1.0, None, None) is None


@pytest.mark.parametrize(("points", "repeats"), [(POINTS, 2), (POINTS, 1), (POINTS[:1], 3), (POINTS[:1], 1)])
def test_what_is_not_known_is_none(points, repeats):
    now = fitted(points, repeats)
    held = holding(now, drawn(now.errors, np.random.default_rng(7)))
    said = error(held, held)
    known = {"fit": True, "repeats": repeats > 1, "heldout": len(points) > 1}
    for what in WHAT:
        assert (said["after"][what] is not None) == known[what]
        assert (said["after_over_before"][what]["value"] is not None) == known[what]
    assert (said["noise_floor"] is None) == (said["noise_floor_ci95"] is None) == (repeats == 1)


def with_atom(now):
    """A fit of the cosine and sine of an atom, without the chain."""
    J = 100 * columns(ATOM, now)
    weighed = J / now.errors.variance[:, None]
    told = np.linalg.solve(np.eye(J.shape[1]) + weighed.T @ J, weighed.T @ now.residual)
    shape = now.calibrated.predicted.shape
    position = dict(zip(("cosine", "sine"), told.tolist(), strict=True))
    predicted = now.calibrated.predicted + (J @ told).reshape(shape)
    calibrated = replace(now.calibrated, position=position, predicted=predicted, J=J.reshape(*shape, -1))
    amplitude = Declared("mV/V", 100.0, lambda _: 0.0, lambda model, _: model)
    return replace(now, parameters=dict.fromkeys(position, amplitude), calibrated=calibrated)


def test_error_of_a_point_left_out_is_that_of_what_the_others_tell():
    """What one point alone shows is predicted as nothing there, and as something where it is not."""
    now = fitted(repeats=1)
    shown = 50 * now.measured.point_rows()[2] * columns(ATOM, now)[:, 0]
    before = holding(replace(now, errors=replace(now.errors, G=now.errors.G[:, :0])), shown)
    after = with_atom(before)
    missed, before_it = (np.linalg.norm(Errors(each, each).heldout, axis=1) for each in (after, before))
    assert missed[2] == pytest.approx(before_it[2])
    assert np.delete(missed, 2).min() > 0.1 * missed[2]
    np.testing.assert_array_equal(np.delete(before_it, 2), 0)


def test_what_a_whole_session_has_off_is_no_error_of_the_model():
    """It is told by the other operating points of the session; noise stays."""
    now = fitted(repeats=1)
    zero = np.tile(LAYOUT.order == 0, len(now.measured)).astype(float)[:, None]
    noise = np.sqrt(now.errors.variance) * np.random.default_rng(3).standard_normal(len(zero))
    off = replace(now, errors=replace(now.errors, G=100 * zero))
    found, quiet = (Errors(held, held) for held in (holding(off, noise + 150 * zero[:, 0]), holding(off, noise)))
    np.testing.assert_allclose(found.fit, quiet.fit, rtol=1e-2)
    np.testing.assert_allclose(found.heldout, quiet.heldout, rtol=1e-2)
    np.testing.assert_array_less(found.heldout, 10)


def test_what_a_model_lacks_is_an_error_though_a_nuisance_could_hide_it():
    """The best model says how much of it is nuisance; by itself, the model before would call it nothing else."""
    now = fitted(repeats=1)
    line = columns(ATOM, now)[:, :1]
    before = holding(replace(now, errors=replace(now.errors, G=30 * line)), 50 * line[:, 0])
    best = with_atom(before)
    shown = of_s2(Errors(holding(before, 50 * line[:, 0]), holding(best, 0 * line[:, 0])).fit)
    assert of_s2(Errors(before, before).heldout) < 0.05 * shown
    assert of_s2(Errors(before, best).heldout) == pytest.approx(shown, rel=0.15)
    assert of_s2(Errors(best, best).heldout) < 0.05 * shown


def of_s2(error):
    """Of all recordings."""
    return rms(error[:, LAYOUT.channels.index("s2")])
