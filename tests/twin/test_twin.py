"""The twin against the gear that made the recordings: parameters, probabilities, severities, units."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.stats import binom, kstest
from twin_fixtures import DRAWN, KNOWLEDGE, PLAN, POINTS, recordings

from swgsim.common.seeds import generator
from swgsim.dataset.simulate_cases import record
from swgsim.effects import Coning
from swgsim.oracle.cells import Cells
from swgsim.oracle.model import observations
from swgsim.oracle.point import PointModel
from swgsim.storage.labelled_signals import CLASSES
from swgsim.twin import FittedGear, References, Twin, fit_gear
from swgsim.twin.twin_study import _diagnosed, _further_healthy, _judged

pytestmark = pytest.mark.end_to_end


@cache
def fitted() -> FittedGear:
    return fit_gear(KNOWLEDGE, References.of(recordings()))


@cache
def twin() -> Twin:
    return Twin.of(KNOWLEDGE, fitted())


def truth() -> np.ndarray:
    return recordings().samples.table["label"].astype(str).to_numpy()


def test_references_identify_the_gear() -> None:
    unit, imperfections = PLAN.bench.unit(DRAWN, generator("unit", PLAN.grid.seed, DRAWN.number))
    found = fitted().model
    # As many numbers as two operating points have, less what 34 parameters take of them.
    assert fitted().misfit == pytest.approx(1, abs=0.3)
    assert fitted().lack == 0
    assert not fitted().offset.any()
    assert found.gear.transmission.k1 == pytest.approx(unit.transmission.k1, rel=0.03)
    assert found.gear.transmission.b1 == pytest.approx(unit.transmission.b1, rel=0.05)
    np.testing.assert_allclose(found.gear.gauges.gain, unit.gauges.gain, atol=0.006)
    for effect, true in zip(found.effects, imperfections, strict=True):
        size, angle = ("r", "theta") if hasattr(true, "r") else ("amplitude", "phase")
        there, here = (getattr(e, size) * np.exp(1j * getattr(e, angle)) for e in (true, effect))
        assert abs(here - there) < 1e-6
    true_error, found_error = (
        {term.order: term.amplitude * np.exp(1j * term.phase) for term in g.transmission.kinematic_error}
        for g in (unit, found.gear)
    )
    for order, there in true_error.items():
        assert abs(found_error[order] - there) < 3e-6


def test_faults_are_not_looked_at() -> None:
    """A twin depends on the references alone, whatever else is among the recordings."""
    only = References.of(recordings().references)
    np.testing.assert_array_equal(References.of(recordings()).mean, only.mean)
    assert only.points == POINTS
    assert only.count.tolist() == [20, 20]


def test_confidence_equals_accuracy() -> None:
    p = _diagnosed(twin(), recordings().samples, of_units=False)[list(CLASSES)].to_numpy()
    np.testing.assert_allclose(p.sum(axis=1), 1, rtol=1e-12)
    right, confidence = np.array(CLASSES)[p.argmax(axis=1)] == truth(), p.max(axis=1)
    assert 0.5 < right.mean() < 0.97
    # Recordings of a gear share what the twin does not know, so they err together: twice the binomial deviation.
    assert abs(right.sum() - confidence.sum()) < 6 * np.sqrt((confidence * (1 - confidence)).sum())


def test_the_table_has_what_is_true_of_every_sample() -> None:
    """So a report judges it without the data set; severity without a prefix is the estimate."""
    table = _judged(KNOWLEDGE, PLAN, DRAWN, 5, recordings(), False, 2)
    assert table["row"].tolist() == list(range(5, 5 + len(truth())))
    assert (table["true:label"] == truth()).all()
    np.testing.assert_array_equal(table["true:severity"], recordings().samples.table["severity"])
    sick = (truth() == "eccentric_wave_generator") & (table["eccentric_wave_generator"] > 0.9)
    np.testing.assert_allclose(table["severity"][sick], table["true:severity"][sick], rtol=0.2)
    assert table["misfit"].nunique() == 1


def test_severities_are_where_their_posterior_says() -> None:
    """Simulation-based calibration: the rank of the true severity is uniform, and 95 % intervals hold 95 % of them."""
    below = _diagnosed(twin(), recordings().samples, of_units=False)["below"].to_numpy()
    assert np.isnan(below[truth() == "healthy"]).all()
    ranks = below[truth() != "healthy"]
    assert kstest(ranks, "uniform").pvalue > 1e-4
    inside = ((ranks > 0.025) & (ranks < 0.975)).sum()
    assert inside > binom.ppf(1e-4, len(ranks), 0.95)


def test_a_unit_is_one_long_observation() -> None:
    both, single = twin().densities(POINTS), [twin().densities([point]) for point in POINTS]
    np.testing.assert_allclose(both.mean, np.concatenate([each.mean for each in single]))
    features = len(single[0].mean)
    np.testing.assert_allclose(both.covariance[:features, :features], single[0].covariance)
    # The level of the friction and the session of the flanges are the same at both points.
    assert both.covariance[features - 2, 2 * features - 2] > 0
    x = observations(recordings().samples)
    units = x.reshape(-1, 2 * features)
    wrong = both.log_posterior(units).argmax(axis=1) != recordings().samples.table["label"].cat.codes.to_numpy()[::2]
    p = _diagnosed(twin(), recordings().samples, of_units=False)[list(CLASSES)].to_numpy()
    assert wrong.mean() < (np.array(CLASSES)[p.argmax(axis=1)] != truth()).mean()


def test_the_mean_of_days_says_all_that_they_say() -> None:
    plan = replace(PLAN, grid=replace(PLAN.grid, days=2, variants=replace(PLAN.grid.variants, count=3), references=1))
    samples = record(plan, list(plan.grid.cases(DRAWN))).samples
    x = observations(samples).reshape(-1, 2, len(POINTS) * observations(samples).shape[1])
    one, mean_of_two = twin().densities(POINTS), twin().densities(POINTS, days=2)
    unsure = np.concatenate(list(fitted().unsure))
    of_gear = unsure @ unsure.T
    of_day = one.covariance - of_gear
    np.testing.assert_allclose(mean_of_two.covariance, of_day / 2 + of_gear)
    one_by_one = PointModel(
        np.tile(one.mean, 2),
        np.kron(np.eye(2), of_day) + np.kron(np.ones((2, 2)), of_gear),
        {name: Cells(np.tile(each.shift, 2), np.tile(each.spread, 2)) for name, each in one.faults.items()},
    )
    np.testing.assert_allclose(
        mean_of_two.log_posterior(x.mean(axis=1)), one_by_one.log_posterior(x.reshape(len(x), -1)), atol=1e-6
    )
    single = one.log_posterior(x[:, 0])
    assert np.exp(mean_of_two.log_posterior(x.mean(axis=1)).max(axis=1)).mean() > np.exp(single.max(axis=1)).mean()


def test_healthy_specimens_of_the_session_are_more_observations() -> None:
    """The twin of the session is the Gaussian distribution of a unit, given healthy specimens with the same errors."""
    healthy = _further_healthy(PLAN, DRAWN, 3)
    one = twin().densities(POINTS)
    shared = np.concatenate(np.concatenate([twin().session, twin().unsure], axis=-1))
    alone = one.covariance - shared @ shared.T
    given = alone / 3 + shared @ shared.T
    gain = shared @ shared.T @ np.linalg.inv(given)
    known = twin().in_session(healthy).densities(POINTS)
    np.testing.assert_allclose(known.mean, one.mean + gain @ (healthy.mean(axis=0).ravel() - one.mean), rtol=1e-6)
    np.testing.assert_allclose(known.covariance, one.covariance - gain @ shared @ shared.T, atol=1e-9)
    efficiency = len(one.mean) // len(POINTS) - 2
    assert known.covariance[efficiency, efficiency] < 0.9 * one.covariance[efficiency, efficiency]
    assert not np.isin(healthy[:, 0, 0], observations(recordings())[:, 0]).any()  # they are not in the data set


def test_another_mesh_is_another_structure() -> None:
    """The factors of the structure take what another truss changes; without them the misfit says so."""
    plan = replace(PLAN, sectors=80)
    cases = [case for case in plan.grid.cases(DRAWN) if case.reference]
    references = References.of(record(plan, cases))
    exact = fit_gear(KNOWLEDGE, references, KNOWLEDGE.start, KNOWLEDGE.parameters())
    assert exact.misfit > 20
    assert exact.lack > 0
    assert np.abs(exact.offset).max() > 0
    assert fit_gear(KNOWLEDGE, references).misfit < 2


def test_declared_effects_are_part_of_the_twin() -> None:
    """A healthy gear with an effect beyond those of a series fits if the effect is declared, and only then."""
    coned = replace(PLAN, effects=(Coning(0.1),))
    references = References.of(record(coned, [case for case in PLAN.grid.cases(DRAWN) if case.reference]))
    told = replace(KNOWLEDGE, plan=replace(KNOWLEDGE.plan, effects=coned.effects))
    with_it, without = (
        fit_gear(each, references, each.start, each.parameters(), turns=1) for each in (told, KNOWLEDGE)
    )
    assert with_it.model.effects[-1] == Coning(0.1)
    assert with_it.misfit < 2
    assert without.misfit > 2 * with_it.misfit


def test_what_is_missing_is_named() -> None:
    one = References.of(recordings().where(recordings().table["T_out_nm"] == POINTS[0].T_out))
    with pytest.raises(ValueError, match=r"no reference at 4000 rpm and 60 N m: record the healthy gear there"):
        fit_gear(KNOWLEDGE, one)
    with pytest.raises(ValueError, match=r"references of 0 gears"):
        References.of(recordings().samples)
