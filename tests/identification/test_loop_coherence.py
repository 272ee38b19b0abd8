"""A cause serves all operating points, channels and orders with one size; a mimic does not."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import Bump, Wave, drawn, fitted_to, holding
from swgsim.identification.decide.candidate import EXACT, widened

from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Model
from swgsim.identification.fit import form_error as evidence
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.form_error import NO_SIZE
from swgsim.identification.fit.priors import Declared, of_effects
from swgsim.identification.fit.unit import STRUCTURE

LAYOUT = Layout(("T_in", "s0", "s1"))
STRONG = 10.0  # in units of the noise, feature by feature


@pytest.fixture
def planted():
    """A model that has an effect fitted, whose size is a parameter as good as free, and the effect's signature."""
    rng = np.random.default_rng(1)
    fitted = fitted_to(LAYOUT, rng, repeats=2)
    whole = fitted.measured.rows(STRONG * rng.standard_normal((len(fitted.measured.situations), len(LAYOUT))))
    return fitted, whole


def split_by_form(fitted, whole, error, rng) -> np.ndarray:
    """A signature whose channels, orders and operating points are each off by a share of their own."""
    measured = fitted.measured
    channels = 1 + error * rng.standard_normal(len(LAYOUT.channels))
    orders = 1 + error * rng.standard_normal(LAYOUT.order.max() + 1)
    points = 1 + error * rng.standard_normal(len(measured.situations))
    of_feature = np.repeat(channels, len(LAYOUT) // len(LAYOUT.channels)) * orders[LAYOUT.order]
    return whole * np.outer(points[measured.of_recording], of_feature).ravel()


@pytest.fixture
def fitted_with(planted, monkeypatch):
    """The effect fitted to a signal on noise, its size open, and its coherence."""
    fitted, whole = planted
    with_effect = replace(fitted.calibrated, model=Model(GEAR, (Bump(1.0),)))
    free = replace(fitted, calibrated=with_effect, open=np.hstack([fitted.open, 10 * whole[:, None]]))
    unit = fitted.whole.whiten(whole)

    def found(signal: np.ndarray, rng: np.random.Generator) -> tuple[Fitted, evidence.Coherence]:
        r = signal + drawn(fitted.whole, rng)
        size = float(unit @ fitted.whole.whiten(r) / (unit @ unit))
        monkeypatch.setattr(evidence, "signature", lambda fitted, number: size * whole)
        held = holding(free, r - size * whole)
        return held, evidence.coherence(held, 0)

    return found


@pytest.fixture
def judged(fitted_with):
    """The coherence alone."""
    return lambda signal, rng: fitted_with(signal, rng)[1]


def test_an_effect_of_exact_form_is_coherent(planted, judged):
    rng = np.random.default_rng(2)
    found = [judged(size * planted[1], rng) for size in (0.5, 1.0, -2.0) * 7]
    assert all(each.holds for each in found)
    assert np.median([each.form_error for each in found]) < 0.03


def test_an_effect_whose_parts_are_off_by_a_fifth_is_coherent(planted, judged):
    rng = np.random.default_rng(3)
    found = [judged(split_by_form(*planted, 0.2, rng), rng) for _ in range(40)]
    assert np.mean([each.holds for each in found]) >= 0.9


@pytest.mark.parametrize("error", [0.1, 0.2, 0.4])
def test_form_error_is_the_one_that_is_there(planted, judged, error):
    rng = np.random.default_rng(4)
    found = np.median([judged(split_by_form(*planted, error, rng), rng).form_error for _ in range(30)])
    assert 0.6 * error < found < 2 * error


@pytest.mark.parametrize("part", ["point", "channel", "order"])
def test_an_effect_in_one_part_only_is_a_mimic(planted, judged, part):
    fitted, whole = planted
    masks = {
        "point": fitted.measured.point_rows()[2],
        "channel": np.tile(LAYOUT.channel == "s0", len(fitted.measured)),
        "order": np.tile(LAYOUT.order == 2, len(fitted.measured)),
    }
    rng = np.random.default_rng(5)
    found = [judged(whole * masks[part], rng) for _ in range(5)]
    assert not any(each.holds for each in found)
    assert all(each.form_error > 0.4 for each in found)


def test_an_effect_of_the_wrong_sign_at_one_point_is_a_mimic(planted, judged):
    fitted, whole = planted
    found = judged(whole * np.where(fitted.measured.point_rows()[0], -1, 1), np.random.default_rng(6))
    assert not found.holds


def test_a_weak_effect_is_not_contradicted_by_noise(planted, judged):
    rng = np.random.default_rng(7)
    found = [judged(0.01 * planted[1], rng) for _ in range(150)]
    assert all(each.holds for each in found)
    assert 0.03 <= np.mean(np.array([each.chance for each in found]) < 0.1) <= 0.2


def test_parts_that_leave_no_size_do_not_agree(planted, judged):
    """Even where the tolerance of form lets it pass for luck: some of the parts say that there is the opposite."""
    fitted, whole = planted
    opposed = np.tile(np.isin(LAYOUT.channel, ["s0", "s1"]), len(fitted.measured))
    found = judged(np.where(opposed, -0.5, 1.0) * whole, np.random.default_rng(8))
    assert found.disagreement >= NO_SIZE
    assert not replace(found, chance=1.0).holds
    assert replace(found, chance=1.0, disagreement=0.9 * NO_SIZE).holds


@pytest.fixture
def of_gauges(planted, monkeypatch):
    """A model with an effect that gauges show, and its signature."""
    fitted, whole = planted
    gauges = whole * (np.tile(LAYOUT.channel != "T_in", len(fitted.measured)))
    monkeypatch.setattr(evidence, "signature", lambda fitted, number: gauges)
    return replace(fitted, calibrated=replace(fitted.calibrated, model=Model(GEAR, (Bump(1.0),)))), gauges


def test_another_structure_does_not_excuse_another_law(of_gauges, monkeypatch):
    """An effect that grows with the third power of the load, where what there is does not follow the load at all."""
    fitted, gauges = of_gauges
    measured = fitted.measured
    load = np.array([situation.point.T_out for situation in measured.situations])[measured.of_recording] / 70
    constant = np.tile(gauges[: len(LAYOUT)], len(measured))
    cubic = np.repeat(load**3, len(LAYOUT)) * constant
    monkeypatch.setattr(evidence, "signature", lambda fitted, number: cubic)
    rng = np.random.default_rng(17)
    for truth, holds in ((constant, False), (cubic, True)):
        unit = replace(fitted.unit, structure=0.3)
        held = replace(fitted, unit=unit, open=np.hstack([fitted.open, 10 * cubic[:, None]]))
        residual = truth - cubic * (cubic @ truth) / (cubic @ cubic) + drawn(fitted.whole, rng)
        assert evidence.coherence(holding(held, residual), 0).holds == holds


def test_where_the_structure_is_another_one_the_power_of_the_load_may_be_too(of_gauges):
    fitted, gauges = of_gauges
    load = np.array([recording.point.T_out for recording in fitted.measured.recordings])
    truth = gauges * np.repeat(load / 39, len(LAYOUT))
    residual = truth - gauges * (gauges @ truth) / (gauges @ gauges) + drawn(fitted.whole, np.random.default_rng(19))
    for structure, holds in ((STRUCTURE, False), (0.1, True)):
        unit = replace(fitted.unit, structure=structure)
        held = replace(fitted, unit=unit, open=np.hstack([fitted.open, 10 * gauges[:, None]]))
        assert evidence.coherence(holding(held, residual), 0).holds == holds


def test_a_size_is_as_doubtful_as_imperfect_forms_of_other_effects_would_make_it(planted, monkeypatch):
    fitted, whole = planted
    rng = np.random.default_rng(18)
    other = fitted.measured.rows(STRONG * rng.standard_normal((len(fitted.measured.situations), len(LAYOUT))))
    held = replace(fitted, open=np.hstack([fitted.open, 10 * other[:, None]]))
    monkeypatch.setattr(evidence, "signature", lambda fitted, number: (whole, other)[number])
    split = evidence.parts(held, other)
    weights = held.whole.whiten(whole)
    moved = weights @ held.whole.whiten(0.3 * split @ rng.standard_normal((split.shape[1], 300))) / (weights @ weights)
    found = evidence.doubt_by_others(held, 0, {1: evidence.Coherence(1.0, form_error=0.3, doubt=0.0)})
    assert found == pytest.approx(moved.std(), rel=0.2)
    assert evidence.doubt_by_others(held, 0, {}) == 0.0


def test_a_phase_is_as_doubtful_as_imperfect_forms_would_make_it(planted, monkeypatch):
    """By as much as parts of all sizes move the likeliest phase; those of another effect move it too."""
    fitted, whole = planted
    rng = np.random.default_rng(22)
    J = STRONG * rng.standard_normal((len(fitted.measured.situations), len(LAYOUT), 3))
    model = Model(GEAR, (Wave(1.0, 0.5), Bump(1.0)))
    parameters = of_effects(model)
    held = replace(fitted, parameters=parameters, calibrated=replace(fitted.calibrated, model=model, J=J))
    other = fitted.measured.rows(J[..., 1]) * np.repeat(rng.uniform(0, 2, len(fitted.measured)), len(LAYOUT))
    monkeypatch.setattr(evidence, "signature", lambda fitted, number: (whole, other)[number])
    off = np.hstack([0.3 * evidence.parts(held, whole), 0.2 * evidence.parts(held, other)])
    likeliest = [held.whole.common_mean(off @ rng.standard_normal(off.shape[1]))[-3:] for _ in range(300)]
    spreads = [parameter.sd for parameter in parameters.values()]
    found = evidence.moved_by_forms(held, {n: evidence.Coherence(1.0, e, 0.0) for n, e in enumerate((0.3, 0.2))})
    assert not any(evidence.moved_by_forms(held, {}).values())
    assert list(found) == ["wave 1: height", "wave 1: theta", "bump 2: height"]
    assert list(found.values()) == pytest.approx(np.std(likeliest, axis=0) * spreads, rel=0.15)
    monkeypatch.setattr("swgsim.identification.decide.candidate.over_shapes", lambda *_: {})
    coherences = [evidence.Coherence(1.0, 0.3, 0.1), evidence.Coherence(1.0, 0.2, 0.4)]
    theta, height = "wave 1: theta", "bump 2: height"
    spread = widened(held, 0, coherences)
    assert spread[theta] == pytest.approx(np.hypot(held.deviation[theta], found[theta]))
    assert spread[height] == pytest.approx(np.linalg.norm([held.deviation[height], 0.4, EXACT]))


def test_a_form_that_is_off_by_a_fifth_costs_little_at_points_left_out(planted, fitted_with):
    rng = np.random.default_rng(10)
    exact = fitted_with(planted[1], rng)[0].predictive.sum()
    for _ in range(5):
        fitted, agreement = fitted_with(split_by_form(*planted, 0.2, rng), rng)
        held, opened = fitted.predictive.sum(), evidence.open_as_found(fitted, [agreement]).predictive.sum()
        assert opened - held > 0.8 * (exact - held) > 50


def test_an_exact_form_gains_next_to_nothing_by_what_is_tolerated(planted, fitted_with):
    rng = np.random.default_rng(11)
    for _ in range(5):
        fitted, agreement = fitted_with(planted[1], rng)
        opened = evidence.open_as_found(fitted, [agreement])
        assert opened.predictive.sum() - fitted.predictive.sum() < 10


def test_a_mimic_is_no_better_than_the_cause_for_what_is_tolerated(planted, fitted_with):
    fitted, whole = planted
    rng = np.random.default_rng(12)
    cause = fitted_with(whole, rng)[0].log_likelihood
    mimic, agreement = fitted_with(whole * np.tile(LAYOUT.channel == "s0", len(fitted.measured)), rng)
    assert agreement.tolerated == evidence.FORM_TOLERANCE < agreement.form_error
    assert evidence.open_as_found(mimic, [agreement]).log_likelihood < cause - 50


def test_what_was_open_before_stays_open_and_each_of_two_effects_has_its_own_form(planted, fitted_with):
    rng = np.random.default_rng(13)
    earlier = rng.standard_normal((len(planted[1]), 3))
    held = fitted_with(planted[1], rng)[0].allowing(earlier)
    exact, off = (evidence.Coherence(1.0, error, 0.0) for error in (0.0, 0.1))
    assert evidence.open_as_found(held, [exact]) is held
    two = replace(held, calibrated=replace(held.calibrated, model=Model(GEAR, (Bump(1.0), Bump(2.0)))))
    opened = evidence.open_as_found(two, [exact, off])
    np.testing.assert_array_equal(opened.allowed.columns[:, :3], earlier)
    parts, found = 0.1 * evidence.parts(two, evidence.signature(two, 1)), opened.allowed.columns[:, 3:]
    # As few columns as say the same.
    np.testing.assert_allclose(found @ found.T, parts @ parts.T, atol=1e-3)
    assert found.shape[1] < parts.shape[1]
    assert not opened.strict.allowed.columns.shape[1]


def test_what_is_open_of_the_unit_is_the_same_whatever_effects_leave_open(planted):
    """It is set up once; the errors, the unit's, those of effects and parameters follow one another."""
    rng = np.random.default_rng(23)
    fitted, whole = planted
    parameters = {name: Declared("-", 1.0, lambda model: 0.0, lambda model, to: model) for name in "ab"}
    J = rng.standard_normal((*fitted.calibrated.predicted.shape, 2))
    calibrated = replace(fitted.calibrated, position=dict.fromkeys(parameters, 0.0), J=J)
    fitted = replace(fitted, calibrated=calibrated, parameters=parameters)
    more = [rng.standard_normal((len(whole), columns)) for columns in (3, 2)]
    opened = fitted.allowing(more[0]).allowing(more[1])
    every = [fitted.errors.columns, fitted.open, opened.allowed.columns, opened.J]
    np.testing.assert_array_equal(opened.whole.columns, np.hstack(every))
    for each, columns in ((opened, every), (opened.strict, [*every[:2], every[3]])):
        anew = Covariance(fitted.errors.alone, np.hstack(columns))
        assert each.log_likelihood == pytest.approx(anew.log_likelihood(fitted.from_start))
        block, _ = each.by_others[0]
        told = anew.left_out(fitted.from_start, [block])[0]
        np.testing.assert_allclose(each.nuisance[block], (anew.columns[:, :-2] @ told.common[:-2])[block])
    noisier = opened.scattering(replace(opened.scatter, sd={name: 3 * sd for name, sd in opened.scatter.sd.items()}))
    assert noisier.of_unit.alone is noisier.errors.alone is not opened.errors.alone


def test_doubt_is_how_far_parts_that_differ_lead_a_size_astray(planted, judged):
    """A size is a mean over the parts; the doubt says how uncertain their differences leave it."""
    rng = np.random.default_rng(8)
    fitted, whole = planted
    unit = fitted.whole.whiten(whole)
    sizes, doubts = [], []
    for _ in range(60):
        signal = split_by_form(fitted, whole, 0.2, rng)
        sizes.append(float(unit @ fitted.whole.whiten(signal) / (unit @ unit)))
        doubts.append(judged(signal, rng).doubt)
    assert 0.5 < np.median(doubts) / np.std(sizes) < 2


def test_doubt_does_not_rest_on_what_rounding_leaves_of_a_size_that_is_open_far(planted, monkeypatch):
    """A size whose range is 1e5 times what it is absorbs its own signature but for the rounding of its derivative."""
    rng = np.random.default_rng(9)
    fitted, whole = planted
    monkeypatch.setattr(evidence, "signature", lambda fitted, number: whole)
    first = [list(fitted.measured.of_recording).index(i) for i in range(len(fitted.measured.situations))]
    derivative = 1e5 * whole.reshape(fitted.measured.values.shape)[first]
    derivative *= 1 + 1e-3 * rng.standard_normal(derivative.shape)
    height = Declared("-", 1.0, lambda model: 0.0, lambda model, to: model)
    one, position = Model(GEAR, (Bump(1.0),)), {"bump 1: height": 0.0}
    calibrated = replace(fitted.calibrated, model=one, position=position, J=derivative[..., None])
    far = replace(fitted, parameters={"bump 1: height": height}, calibrated=calibrated)
    residual = split_by_form(fitted, whole, 0.2, rng) - whole + drawn(fitted.errors, rng)
    found = evidence.coherence(holding(far, residual), 0)
    assert found.form_error > 0.05
    assert found.doubt < 2 * found.form_error
