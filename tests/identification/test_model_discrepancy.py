"""A healthy gear differs from the model near a resonance, at one operating point and not at another."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import drawn, fitted_to, holding
from small_bench import SECTORS, coarse_model

from swgsim.bench.scatter import Bench
from swgsim.bench.virtual_bench import Sessions, record_sessions
from swgsim.blind.bench import UNSEEN
from swgsim.blind.prediction import expected
from swgsim.effects.library import LIBRARY
from swgsim.gear.acquisition import Window
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.commissioning.commissioning import learn_unit
from swgsim.identification.commissioning.probable_discrepancy import probable
from swgsim.identification.covariance.model_discrepancy import Discrepancy
from swgsim.identification.data.features import Layout
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model, Situation, predict
from swgsim.identification.decide.decision import decide
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import fit
from swgsim.identification.fit.unit import Unit
from swgsim.recordings.recording import Recording

POINTS = tuple(OperatingPoint(n, T) for n in (1000.0, 2000.0, 4000.0) for T in (7.0, 70.0))
LAYOUT = Layout(("T_out", "s1"))
# Share by which the torque's line of order 2 is off at some operating points, as by a resonance that the model lacks.
OFF = {POINTS[2]: 0.05, POINTS[3]: -0.04j, POINTS[5]: 0.03j}


SITUATIONS = [Situation(point, Conditions()) for point in POINTS[:2]]


def of_torque() -> Discrepancy:
    """Of 0.1 in the torque, beside a noise of 1, determined in its line of order 4 at one operating point."""
    determined = np.zeros((2, 2, 13), bool)
    determined[1, 0, 4] = True
    return Discrepancy(np.array([0.1, 0.0]), np.ones((2, 13)), POINTS[:2], determined)


def test_a_discrepancy_is_a_complex_factor_on_one_line_at_one_operating_point():
    predicted = np.random.default_rng(1).normal(size=(2, len(LAYOUT)))
    real, imaginary = np.moveaxis(of_torque().columns(SITUATIONS, predicted, LAYOUT), -1, 0)
    before, after = LAYOUT.lines(predicted), LAYOUT.lines(predicted + 2 * real - 3 * imaginary)
    factor = np.ones((2, 2, 13), complex)
    factor[1, 0, 4] = 1 + 0.1 * (2 - 3j)
    np.testing.assert_allclose(after, before * factor)


def test_of_a_line_that_healthy_recordings_do_not_show_it_is_open_as_soon_as_there_is_one():
    lines = np.full((2, 2, 13), 0.5, complex)
    lines[0, 0, 4] = lines[1, 0, 4] = lines[1, 0, 7] = lines[1, 1, 7] = 2.0
    predicted = LAYOUT.vector(lines)
    columns = of_torque().undetermined(SITUATIONS, predicted, LAYOUT)
    changed = np.abs(LAYOUT.lines(np.moveaxis(columns, -1, 0))) > 0
    assert [list(zip(*np.nonzero(each), strict=True)) for each in changed] == [
        [(0, 0, 4)], [(0, 0, 4)], [(1, 0, 7)], [(1, 0, 7)],
    ]  # fmt: skip


def test_a_discrepancy_is_found_where_there_is_one_and_rarely_in_noise():
    layout = Layout(("n_in", "T_out", "s1"))

    def found(off: float) -> list[bool]:
        fits = (_with_ripple(layout, np.random.default_rng(seed), off) for seed in range(20))
        return [bool(probable(fitted).sd.any()) for fitted in fits]

    assert all(found(0.02))
    assert sum(found(0.0)) <= 2


def _with_ripple(layout: Layout, rng: np.random.Generator, off: float) -> Fitted:
    """A fit to a ripple of 100 in units of the noise, whose lines of the torque are off by a share at each point."""
    fitted = fitted_to(layout, rng, repeats=3)
    measured = fitted.measured
    predicted = rng.normal(0, 100, (len(measured.situations), len(layout)))
    fitted = replace(fitted, calibrated=replace(fitted.calibrated, predicted=predicted))
    factor = 1 + off * rng.normal(size=predicted.shape) * (layout.channel == "T_out")
    return holding(fitted, measured.rows(factor * predicted) + drawn(fitted.whole, rng))


@pytest.fixture(scope="module", autouse=True)
def _coarse_mesh() -> Iterator[None]:
    with coarse_model():
        yield


def recorded(seed: int, effects=()) -> Measured:
    """Recordings of a gear whose torque at the output is off the model."""
    plan = Sessions(POINTS, repeats=3, revolutions=6, warming=0.0, unsteady=0.0, thermometer=0.0)
    recordings = record_sessions(GEAR, effects, plan, Bench(), seed=seed, window=Window(), sectors=SECTORS)
    return Measured.of([_off(replace(each, conditions=Conditions(25.01))) for each in recordings])


def _off(recording: Recording) -> Recording:
    torque, turn = recording.channels["T_out"], np.exp(2j * recording.channels["phi_in"])
    line = 2 * (torque * turn.conj()).mean()
    return replace(
        recording,
        channels={**recording.channels, "T_out": torque + (OFF.get(recording.point, 0) * line * turn).real},
    )


@pytest.fixture(scope="module")
def unit(_coarse_mesh) -> Unit:
    """The gear as commissioned."""
    return learn_unit(recorded(1), Unit(Model(GEAR)))


@pytest.mark.slow
def test_commissioning_finds_how_large_it_is_and_what_it_is(unit):
    assert unit.discrepancy is not None
    assert unit.discrepancy.sd[:3].max() in (0.01, 0.03)
    assert not unit.discrepancy.sd[3:].any()
    situations = [Situation(point, Conditions(25.01)) for point in POINTS]
    layout = Layout(("n_in", "T_in", "T_out", "s0", "s1", "s2", "s3", "s4"))
    open_ = unit.left_open(unit.model, situations, layout)
    off = layout.lines(open_.predicted + open_.shift)[:, 2, 2] / layout.lines(open_.predicted)[:, 2, 2]
    off /= off[0]  # what all have in common is a parameter's
    assert off[2:4] == pytest.approx([1 + OFF[POINTS[2]], 1 + OFF[POINTS[3]]], abs=0.02)


@pytest.mark.slow
def test_what_it_was_in_the_healthy_gear_is_no_news(unit):
    searched = [LIBRARY[name] for name in ("eccentric_wave_generator", "reduced_damping", "load_torque_ripple")]
    assert not decide(recorded(2), unit, searched).effects
    (found,) = decide(recorded(3, (searched[0](10e-6, 1.0),)), unit, searched).effects
    assert found.r == pytest.approx(10e-6, rel=0.2)


@pytest.mark.slow
def test_at_another_operating_point_it_is_as_uncertain_as_before_it_was_found(unit):
    layout = Layout(("n_in", "T_in", "T_out", "s0", "s1", "s2", "s3", "s4"))
    line = (layout.channel == "T_out") & (layout.order == 2)

    def spread(point: OperatingPoint) -> float:
        open_ = unit.left_open(unit.model, [Situation(point, Conditions(25.01))], layout)
        (columns,) = np.concatenate([open_.columns, open_.undetermined], axis=-1)
        return float(np.sqrt((columns[line] ** 2).sum()))

    elsewhere = OperatingPoint(3000.0, 30.0)
    (predicted,) = predict([unit.model], [Situation(elsewhere, Conditions(25.01))], layout)[0]
    amplitude = np.hypot(*predicted[line])
    assert spread(elsewhere) > unit.discrepancy.sd.max() * amplitude
    assert spread(POINTS[2]) < spread(elsewhere) / 2


@pytest.mark.slow
def test_a_unit_with_a_discrepancy_is_the_same_from_its_file(unit, tmp_path):
    unit.save(tmp_path / "gear.unit.h5")
    again = Unit.load(tmp_path / "gear.unit.h5")
    layout = Layout(("n_in", "T_in", "T_out", "s0", "s1", "s2", "s3", "s4"))
    situations = [Situation(point, Conditions(25.01)) for point in (*POINTS, OperatingPoint(3000.0, 30.0))]
    for one, other in zip(*(each.left_open(each.model, situations, layout) for each in (unit, again)), strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.slow
def test_where_nothing_was_recorded_the_prediction_has_what_is_known(unit):
    """Also of a unit with a discrepancy, whose directions differ from one set of operating points to another."""
    fitted = fit(recorded(2), unit)
    expected_there = expected(fitted)
    (truth,) = predict([unit.model], UNSEEN, fitted.measured.layout)
    lobes = (fitted.measured.layout.channel == "s1") & (fitted.measured.layout.order == 2)
    np.testing.assert_allclose(expected_there[:, lobes], truth[:, lobes], atol=2e-3)
