"""Where a fit begins."""

from dataclasses import replace

import numpy as np
import pytest
from bench_fixtures import POINTS, good
from chain_fixtures import GEAR

from swgsim.effects import Effect
from swgsim.effects.clipping import Clipping
from swgsim.effects.root_tooth_crack import RootToothCrack
from swgsim.effects.zero_offset import ZeroOffset
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.covariance.scatter import STATED
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model
from swgsim.identification.fit import fitting
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import (
    IMPROBABLE,
    MOST_TURNS,
    MOST_TURNS_UNREPEATED,
    SAME_SCATTER,
    at_plausible_parameters,
    extended,
    fit,
)
from swgsim.identification.fit.unit import Unit
from swgsim.identification.search import refining
from swgsim.identification.search.hypotheses import hypotheses, signatures
from swgsim.identification.search.refining import zoom
from swgsim.identification.search.screening import Score, screen

pytestmark = pytest.mark.end_to_end


def asked(*hidden: Effect, points: tuple[OperatingPoint, ...] = POINTS) -> tuple[Fitted, Score]:
    """A model without the effects that recordings have, and the best hypothesis of the first of them."""
    measured = Measured.of(good(effects=hidden, repeats=1, points=points))
    # A unit of which only the maps are not known, so that nothing is fitted.
    maps = Unit(Model(GEAR)).left_open(Model(GEAR), measured.situations, measured.layout).columns.shape[-1]
    fitted = fit(measured, Unit(Model(GEAR), reach=np.eye(maps)))
    found = list(hypotheses([type(hidden[0])]))
    return fitted, screen(found, signatures(found, fitted.model, fitted.measured), fitted, np.random.default_rng(1))[0]


@pytest.mark.parametrize("level", [0.12, 0.14])
def test_an_effect_far_from_proportional_begins_near_its_size(level):
    fitted, score = asked(Clipping(level))
    begun = zoom(score, fitted)
    assert isinstance(begun, Clipping)
    # Sizes are tried in steps of a factor 1.8, and then in a dozen between the neighbours of the best.
    assert begun.level == pytest.approx(level, rel=0.2)
    assert abs(np.log(score.estimate / level)) > np.log(2)


def test_an_effect_whose_typical_size_does_nothing_here_is_seen():
    """At this load no signal reaches the typical level."""
    level = 0.2
    fitted, score = asked(Clipping(level), points=(OperatingPoint(2000, 30), OperatingPoint(4000, 30)))
    sizes = list(hypotheses([Clipping]))
    typical, *further = signatures(sizes, fitted.model, fitted.measured)
    assert not typical.any()
    assert all(signature.any() for signature in further)
    assert score.chance < 0.01
    begun = zoom(score, fitted)
    assert isinstance(begun, Clipping)
    assert begun.level == pytest.approx(level, rel=0.05)


@pytest.mark.slow
def test_effects_of_a_unit_that_was_bent_begin_at_what_is_declared_of_it():
    measured = Measured.of(good(effects=(Clipping(0.15),), repeats=1))
    now = fit(measured, Unit(Model(GEAR)))
    assert max(map(abs, now.position_of_unit.values())) > IMPROBABLE
    start = at_plausible_parameters(now)
    assert set(start.calibrated.position.values()) == {0.0}
    assert start.model == now.unit.model
    kept = replace(now, calibrated=replace(now.calibrated, position=dict.fromkeys(now.parameters, 0.9 * IMPROBABLE)))
    assert at_plausible_parameters(kept) is kept


def test_a_unit_that_is_far_from_what_is_declared_and_fits_is_not_bent():
    unit = Unit(Model(replace(GEAR, gauges=replace(GEAR.gauges, offset=(0.0, 0.2, 0.0, 0.0, 0.0)))))
    now = fit(Measured.of(good(repeats=1)), unit)
    assert now.position_of_unit["zero of s1"] == pytest.approx(-10, rel=0.1)
    assert at_plausible_parameters(now) is now


@pytest.fixture(scope="module")
def found() -> Fitted:
    """A model fitted to what it made, three times at every point."""
    return fit(Measured.of(good(repeats=3)), Unit(Model(GEAR)))


def test_errors_of_single_recordings_are_those_of_the_repeats_wherever_a_fit_begins(found):
    assert found.scatter.sd["trigger"] < STATED["trigger"] / 10
    far = fit(found.measured, found.unit, position={"k1": 2.0, "b0": -1.0, "gain of s1": 2.0})
    assert far.errors.alone.divergence(far.scattering(found.scatter).errors.alone) < SAME_SCATTER
    for name, there in found.calibrated.position.items():
        # A fit rests where a step no longer counts; weakly determined parameters stop a part of their deviation apart.
        deviation = found.deviation[name] / found.parameters[name].sd
        assert far.calibrated.position[name] == pytest.approx(there, abs=0.7 * deviation)


@pytest.mark.parametrize("repeats", [1, 3])
def test_repeats_tell_the_errors_of_single_recordings_before_anything_is_fitted(monkeypatch, repeats):
    """Without repeats a fit begins with those that a bench states."""
    begun, turn = [], fitting._turn

    def kept(*given):
        found, assumed = turn(*given)
        begun.append(assumed)
        return found, assumed

    monkeypatch.setattr(fitting, "_turn", kept)
    fit(Measured.of(good(repeats=repeats)), Unit(Model(GEAR)), turns=1)
    (assumed,) = begun
    if repeats == 1:
        assert assumed.sd == STATED
    else:
        assert assumed.sd["trigger"] < STATED["trigger"] / 10


@pytest.mark.parametrize(
    ("sizes", "settled", "repeats", "turns"),
    [
        ([1.01, 9], True, 3, 1),
        ([5, 1, 1.01, 9], True, 3, 3),
        ([5, 1, 5, 1, 5], True, 3, MOST_TURNS),
        ([1] * 9, False, 3, MOST_TURNS),
        ([5, 1, 5, 1], True, 1, MOST_TURNS_UNREPEATED),
    ],
)
def test_a_fit_goes_on_until_the_errors_of_single_recordings_stay(monkeypatch, found, sizes, settled, repeats, turns):
    """Each turn finds them so many times as large as in the fit that it begins at."""
    begun, left = [], iter(sizes)

    def turn(fixed, begin, assumed):
        begun.append(assumed)
        size = next(left)
        made = found.scattering(replace(found.scatter, sd={name: size * sd for name, sd in found.scatter.sd.items()}))
        return replace(made, calibrated=replace(made.calibrated, settled=settled)), assumed or found.scatter

    monkeypatch.setattr(fitting, "_turn", turn)
    extended(replace(found, measured=Measured.of(good(repeats=repeats))), ())
    assert len(begun) == turns


def test_a_proportional_effect_begins_at_its_estimate():
    fitted, score = asked(ZeroOffset(0, 0.08))
    begun = zoom(score, fitted)
    assert isinstance(begun, ZeroOffset)
    assert (begun.sensor, begun.offset) == (0, pytest.approx(score.estimate, rel=1e-3))
    assert score.estimate == pytest.approx(0.08, rel=0.1)


def test_a_place_that_acts_in_steps_is_found_where_the_chain_has_it(monkeypatch):
    """Gaps of 0.0628 rad, of which the right one is two away, at another size than the one to begin with."""

    def left(_, effects):
        gaps = [int(effect.theta / (0.02 * np.pi)) for effect in effects]
        return np.array([abs(gap - 25) + abs(e.stiffness_ratio - 0.5) for gap, e in zip(gaps, effects, strict=True)])

    monkeypatch.setattr(refining, "_left", left)
    found = refining._at_its_place(RootToothCrack(0.2, 1.72), None)
    assert int(found.theta / (0.02 * np.pi)) == 25
    assert found.stiffness_ratio == pytest.approx(0.5, abs=0.1)
    straight = Clipping(0.2)
    assert refining._at_its_place(straight, None) is straight


def test_a_crack_begins_in_the_gap_that_is_nearest():
    """The bench's coarser mesh has it at 0.864 rad, in the gap from 0.817 to 0.880 of the model."""
    fitted, score = asked(RootToothCrack(0.5, 0.9))
    assert 0.817 < zoom(score, fitted).theta < 0.880
