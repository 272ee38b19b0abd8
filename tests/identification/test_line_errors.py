"""Errors of lines of an effect on a gear of another structure: their groups, likelihood and estimate."""

from dataclasses import replace

import numpy as np
import pytest
from linear_chain import KINDS, Bump, Dip, patch_chain, signatures_of
from loop_fixtures import fitted_to, holding
from scipy.special import logsumexp
from scipy.stats import norm

from swgsim.effects.cam_form import CamForm
from swgsim.identification.data.features import ORDERS, Layout
from swgsim.identification.decide import line_proposals
from swgsim.identification.decide.line_errors import LineErrors, groups
from swgsim.identification.decide.line_evidence import with_effect_known
from swgsim.identification.decide.line_proposals import LineProposals
from swgsim.identification.decide.option import option, resembling
from swgsim.identification.decide.prior import EXACT_LINE, LEAST_ERROR
from swgsim.identification.fit.priors import name_of
from swgsim.identification.fit.unit import Unit
from swgsim.identification.search.hypotheses import Hypothesis

LAYOUT = Layout(("T_out", "s0", "s1", "s2", "s3", "s4"))
SINGLE = [2, 3, 4, 5]


@pytest.fixture(scope="module")
def measured():
    """With the same noise in all channels, so that lines of equal amplitude count equally."""
    found = fitted_to(LAYOUT, np.random.default_rng(1)).measured
    return replace(found, variance=np.full_like(found.variance, 0.04))


def rows(measured, lines):
    """The same lines in every recording."""
    return np.tile(LAYOUT.vector(lines), len(measured))


def along(measured, lines):
    """Mean square of lines in each group."""
    found = groups(measured)
    return np.add.reduceat((found.weights.T @ rows(measured, lines)) ** 2, found.first)


def test_groups_are_all_lines_of_gauges_and_nothing_twice(measured):
    found = groups(measured)
    loads = len({r.point.T_out for r in measured.recordings})
    assert found.weights.T @ found.columns == pytest.approx(np.eye(found.columns.shape[1]), abs=1e-9)
    assert found.columns.shape[1] == loads * LAYOUT.of_gauges.sum()
    assert not found.columns[np.tile(~LAYOUT.of_gauges, len(measured))].any()


@pytest.mark.parametrize("order", range(1, ORDERS + 1))
def test_what_turns_with_the_wave_generator_is_one_group_of_each_order(measured, order):
    """s1 to s4 see the same line one after the other, a quarter of a turn later each; its phase is any."""
    lines = np.zeros((len(LAYOUT.channels), ORDERS + 1), complex)
    lines[SINGLE, order] = np.exp(0.7j) * 1j ** (-order * np.arange(4))
    square = along(measured, lines)
    assert square.max() == pytest.approx(square.sum())


def test_what_is_uneven_around_the_flex_spline_is_two_groups_of_each_order(measured):
    """One period around it, seen through two lobes."""
    lines = np.zeros((len(LAYOUT.channels), ORDERS + 1), complex)
    gauge = np.pi / 2 * np.arange(4)
    lines[SINGLE, 2] = np.exp(-2j * gauge) * np.cos(gauge - 0.4)
    square = np.sort(along(measured, lines))[::-1]
    assert square[:2].sum() == pytest.approx(square.sum())
    assert square[1] == pytest.approx(square[0])


def test_the_largest_line_is_no_offset(measured):
    """Zeros move, so that an offset says nothing of the size of an effect."""
    lines = np.zeros((len(LAYOUT.channels), ORDERS + 1), complex)
    lines[SINGLE, 0] = 1.0
    found = groups(measured)
    assert found.largest(rows(measured, lines)[None] @ found.weights) == pytest.approx(0.0, abs=1e-9)


def test_without_all_four_gauges_every_gauge_is_its_own(measured):
    """Of three gauges nothing says which wave a line is."""
    some = Layout(("T_out", "s1", "s2", "s4"))
    kept = np.isin(LAYOUT.channel, some.channels)
    fewer = replace(measured, layout=some, values=measured.values[:, kept], variance=measured.variance[:, kept])
    assert len(groups(fewer).first) == 3 * (ORDERS + 1)


def test_an_error_is_as_large_however_many_recordings_a_load_has(measured):
    """In standard deviations of the noise of a recording."""
    found = groups(measured)
    white = found.columns / np.sqrt(measured.variance.ravel())[:, None]
    of_recording = (white.reshape(len(measured), -1, white.shape[1]) ** 2).sum(axis=1)
    assert of_recording[of_recording > 1e-9] == pytest.approx(1.0)


def one_group(columns):
    """A group along unit vectors: an error of one standard deviation of the noise is one whitened."""
    return LineErrors(np.eye(columns), np.ones(columns), np.array([0]))


@pytest.mark.parametrize("residual", [0.0, 1.0, 10.0, 60.0])
def test_gain_is_the_integral_over_the_logarithm_of_the_error(residual):
    """Numerically: of four lines that are 0.3 to 100 standard deviations of the noise off, or not at all."""
    r, largest = residual * np.array([1.0, -0.5, 0.2, 0.9]), 100.0
    log_errors = np.linspace(np.log(LEAST_ERROR), np.log(largest), 2001)
    densities = norm.logpdf(r, scale=np.hypot(1, np.exp(log_errors))[:, None]).sum(axis=1) - norm.logpdf(r).sum()
    mean = logsumexp(densities) - np.log(len(densities))
    expected = np.logaddexp(np.log(1 - EXACT_LINE) + mean, np.log(EXACT_LINE))
    (gain,) = one_group(4).gain(r[None], np.array([largest]))
    assert gain == pytest.approx(expected, abs=0.1)


def test_errors_are_as_large_as_the_residual_tells():
    """A group that is explained is nearly closed, one that is off by 50 standard deviations is open by as much."""
    errors = LineErrors(np.eye(8), np.ones(8), np.array([0, 4]))
    deviations = errors.deviations(np.array([0.5, -1.0, 0.3, 0.9, 50.0, -40.0, 60.0, 45.0]), 200.0)
    assert (deviations[:4] < 0.7).all()
    assert deviations[4:] == pytest.approx(np.full(4, 50.0), rel=0.3)


def test_a_fit_with_these_errors_raises_the_likelihood():
    """Steps of expectation maximisation for the size of a signature that explains one of three groups."""
    rng = np.random.default_rng(2)
    errors = LineErrors(np.eye(12), np.ones(12), np.array([0, 4, 8]))
    signature = np.array([200.0, -150.0, 90.0, 120.0, 5.0, 0, 3.0, 0, 1.0, 0, 2.0, 0])
    recorded = signature + np.concatenate([rng.normal(size=4), 40 * rng.normal(size=8)])
    size, largest, gains = 0.5, 50.0, []
    for _ in range(6):
        left = recorded - size * signature
        gains.append(errors.gain(left[None], np.array([largest]))[0] - left @ left / 2)
        weights = 1 / (1 + errors.deviations(left, largest) ** 2)
        size = (weights * signature) @ recorded / ((weights * signature) @ signature)
    assert (np.diff(gains) > -1e-9).all()
    assert size == pytest.approx(1.0, abs=0.02)


def test_size_and_phase_are_those_of_the_lines_that_an_effect_explains(monkeypatch):
    """Of a cam whose other lines, of the same waves, are 40 times the noise off: least squares would follow them."""
    rng = np.random.default_rng(3)
    null = fitted_to(LAYOUT, rng)
    found = groups(null.measured)
    main, *others = [slice(first, first + count) for first, count in zip(found.first, found.counts, strict=True)][5:9]
    signature = 200 * found.columns[:, main] @ rng.normal(size=(main.stop - main.start, 2))
    for other in others:
        signature += 10 * found.columns[:, other] @ rng.normal(size=(other.stop - other.start, 2))
    recorded = 2 * signature @ [np.cos(0.7), np.sin(0.7)] + rng.normal(size=len(signature)) * np.sqrt(
        null.measured.variance.ravel()
    )
    recorded += sum(40 * found.columns[:, each] @ rng.normal(size=each.stop - each.start) for each in others)
    every = [Hypothesis(CamForm, (("n", 3),), 1)]

    def at_size(asked, *_):
        return [each.typical / every[0].typical * signature for each in asked]

    monkeypatch.setattr(line_proposals, "signatures", at_size)
    (proposal,) = LineProposals(holding(null, recorded)).leading(every, [signature], 5)
    assert proposal.effect.amplitude == pytest.approx(2 * every[0].typical, rel=0.05)
    assert proposal.effect.phase == pytest.approx(0.7, abs=0.05)
    assert proposal.start.allowed.forms.any()


def test_an_effect_whose_lines_differ_is_weighed_with_their_errors(monkeypatch):
    """Lines of another group are 30 times the noise off: with errors of lines the effect is found, and its evidence is
    that of a residual which these explain, less what their errors and its size cost.
    """
    rng = np.random.default_rng(4)
    null = fitted_to(LAYOUT, rng)
    changes = signatures_of(null, rng)
    patch_chain(monkeypatch, null, changes)
    found = groups(null.measured)
    off = slice(found.first[6], found.first[7])
    wrong = 30 * found.columns[:, off] @ rng.normal(size=off.stop - off.start)
    signal = 90 * changes[Bump].ravel()
    held = holding(null, signal + wrong + rng.normal(size=len(signal)) * np.sqrt(null.measured.variance.ravel()))
    exact = option(held, (Bump(90.0),), (), len(KINDS))
    monkeypatch.setattr(Unit, "opens", lambda _, effect: effect is Bump or isinstance(effect, Bump))
    opened = option(held, (Bump(90.0),), (), len(KINDS))
    assert not exact.lines_differ
    assert opened.lines_differ
    assert opened.log_evidence > exact.log_evidence + 50
    assert opened.effects[0].height == pytest.approx(90, rel=0.02)
    assert 0 < opened.form_error < 0.3
    (unknown,) = resembling(opened, len(KINDS))
    assert unknown.unknown
    assert unknown.log_posterior < opened.log_posterior


def test_a_declared_effect_stays_free_where_the_added_one_is_held(monkeypatch):
    rng = np.random.default_rng(5)
    null = fitted_to(LAYOUT, rng)
    patch_chain(monkeypatch, null, signatures_of(null, rng))
    model = null.unit.model.plus(Dip(1.0))
    declared = replace(null, unit=Unit(model), calibrated=replace(null.calibrated, model=model))
    fitted = option(declared, (Bump(5.0),), (), len(KINDS)).fitted
    held = with_effect_known(fitted)
    assert set(fitted.parameters) == {name_of(Dip(1.0), 0, "height"), name_of(Bump(5.0), 1, "height")}
    assert list(held.parameters) == list(held.calibrated.position) == [name_of(Dip(1.0), 0, "height")]
    its = list(fitted.parameters).index(*held.parameters)
    np.testing.assert_array_equal(held.J, fitted.J[:, [its]])
