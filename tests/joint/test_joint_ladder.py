"""The ladder on simulated joints: hidden effects are found and named, and joints without effects give none."""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from joint_fixtures import NOTHING, PER_TORQUE, Hidden, Wave, sessions, steady, trajectories, trajectory, upright

from swgsim.joint.effects import SEARCHED
from swgsim.joint.effects.friction import StribeckFriction
from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.ladder import Ladder, forward_selection
from swgsim.joint.orders import lines
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Table, fit, rms
from swgsim.joint.shaping import gain, shaped
from swgsim.joint.term import Term
from swgsim.joint.textbook import textbook
from swgsim.joint.waves import waves

pytestmark = pytest.mark.end_to_end

# Enough speeds to separate one law of friction from another.
SOME = (0.05, 0.1, 0.25, 0.55, 1.0)


def climbed(recordings: tuple[JointRecording, ...], of: str) -> Ladder:
    return forward_selection(Table(recordings, of), SEARCHED)


def names(ladder: Ladder) -> list[str]:
    return [type(step.term).__name__ for step in ladder.steps]


def days(seed: object, hidden: Hidden = NOTHING, which: str = "AB") -> tuple[JointRecording, ...]:
    return sessions(seed, hidden, which, SOME, rate=100.0, seconds=3.0)


def short_days(seed: object, hidden: Hidden = NOTHING) -> tuple[JointRecording, ...]:
    return sessions(seed, hidden, "AB", SOME[::2], rate=80.0, seconds=2.0)


def runs(seed: object, hidden: Hidden = NOTHING, weight: float = 40.0) -> tuple[JointRecording, ...]:
    return trajectories(seed, hidden, weight=weight, rate=50.0)


# Hidden effect, its signal, its name, its order or None, the size of its first wave or weight.
STEADY = {
    "ripple": (Hidden(ripple=(Wave(200.0, 0.02),)), "T_sensor", "Ripple", 200.0, 0.02),
    "ripple of the output": (Hidden(ripple=(Wave(8.0, 0.02),)), "T_sensor", "Ripple", 8.0, 0.02),
    "cogging": (Hidden(cogging=(Wave(200.0, 0.05),)), "current", "Ripple", 200.0, 0.05),
    "stribeck": (Hidden(stribeck=(0.15, 0.15)), "current", "StribeckFriction", None, 0.15),
    "sublinear": (Hidden(sublinear=1.0), "current", "SublinearFriction", None, None),
    "quadratic": (Hidden(quadratic=0.3), "current", "QuadraticFriction", None, 0.3),
}
MOVED = {
    "load": (Hidden(load=0.01), "current", "LoadDependentFriction", None, 0.01),
    "presliding": (Hidden(presliding=(0.3, 0.01)), "current", "MaxwellSlip", None, 0.3),
    "gravity": (Hidden(gravity=0.1), "current", "GravityError", None, None),
    "inertia": (Hidden(inertia=0.1), "current", "InertiaError", None, 0.1),
    "asymmetric": (Hidden(asymmetric=0.1), "current", "AsymmetricFriction", None, None),
    "tight": (Hidden(tight=(Wave(101.0, 0.08),)), "current", "PositionFriction", 101.0, None),
    "cogging": (Hidden(cogging=(Wave(202.0, 0.08),)), "current", "Ripple", 202.0, 0.08),
}


@cache
def steady_ladder(case: str) -> Ladder:
    hidden, of, *_ = STEADY[case]
    return climbed(days(case, hidden), of)


@cache
def moved_ladder(case: str) -> Ladder:
    hidden, of, *_ = MOVED[case]
    return climbed(runs(case, hidden), of)


def check(ladder: Ladder, floor: float, name: str, order: float | None, size: float | None) -> None:
    first = ladder.steps[0].fit.terms[-1]
    assert type(first).__name__ == name
    if order is not None:
        assert getattr(first, "order", None) == order
    # The error of the same draws of noise without the effect.
    assert ladder.top.error < 1.03 * floor
    assert ladder.textbook.error > 1.08 * floor
    if size is not None:
        found = getattr(first, "amplitude", max(first.weights))
        deviation = first_deviation(ladder, first)
        assert abs(found - size) < 2 * deviation


def first_deviation(ladder: Ladder, first: Term) -> float:
    """Largest half width of the intervals of the effect that was found first."""
    start = len(ladder.textbook.weights)
    return float(ladder.steps[0].fit.half_interval[start : start + len(first.weights)].max())


@pytest.mark.parametrize("case", STEADY)
def test_a_hidden_effect_is_found_first_in_steady_runs(case: str) -> None:
    hidden, of, name, order, size = STEADY[case]
    ladder, without = steady_ladder(case), days(case)
    check(ladder, fit(Table(without, of), textbook(without, of)).error, name, order, size)
    held_out, without = Table(days(case, hidden, "C"), of), days(case, which="C")
    floor = fit(Table(without, of), textbook(without, of)).error
    assert rms(ladder.top.missed(held_out)) < 1.05 * floor
    assert rms(ladder.textbook.missed(held_out)) > 1.08 * floor


@pytest.mark.parametrize("case", MOVED)
def test_a_hidden_effect_is_found_first_in_trajectories(case: str) -> None:
    _, of, name, order, size = MOVED[case]
    without = runs(case)
    check(moved_ladder(case), fit(Table(without, of), textbook(without, of)).error, name, order, size)


@pytest.mark.slow
def test_nothing_is_found_where_nothing_is_hidden() -> None:
    """16 draws, of which one may show something by luck."""
    findings = []
    for draw in range(4):
        findings.append(names(climbed(short_days(("nothing", draw)), "T_sensor")))
        findings.append(names(climbed(short_days(("nothing", draw)), "current")))
    findings += [names(climbed(runs(("nothing", draw)), "current")) for draw in range(8)]
    assert sum(map(bool, findings)) <= 1, findings


def arm(number: int, seed: object, e: float) -> JointRecording:
    """A joint that lifts a link and, beyond another joint, a second one; its angle is read wrong by e cos(q + 0.7)."""
    level = trajectory(number, seed, weight=0.0, rate=50.0)
    q, other = level.signals["q"], trajectory(number + 10, seed, rate=50.0).signals["q"]
    read = q + e * np.cos(q + 0.7)
    loads = [30 * np.cos(angle) + 20 * np.cos(angle + other) for angle in (q, read)]
    signals = {
        "q": read,
        "omega": level.signals["omega"] * (1 - e * np.sin(q + 0.7)),
        "current": level.signals["current"] + PER_TORQUE * loads[0],
        "T_rigid": level.signals["T_rigid"] + loads[1],
    }
    return replace(level, signals=signals, posture=np.stack([read, other]))


def test_an_encoder_off_its_axis_is_found_with_its_size_and_only_where_it_is() -> None:
    found = climbed(tuple(arm(number, "eccentric", 0.02) for number in range(4)), "current")
    assert names(found)[:1] == ["EncoderEccentricity"]
    first = found.steps[0].fit.terms[-1]
    assert np.hypot(*first.weights) == pytest.approx(0.02 * PER_TORQUE, abs=2 * first_deviation(found, first))
    assert names(climbed(tuple(arm(number, "eccentric", 0.0) for number in range(4)), "current")) == []


def test_a_wave_that_the_inertia_of_the_arm_reduces_is_found_with_its_size_and_resonance() -> None:
    found = climbed(tuple(upright(number, "upright", 0.3) for number in range(4)), "current")
    assert names(found)[:1] == ["InertiaRipple"]
    first = found.steps[0].fit.terms[-1]
    assert (first.order, first.power) == (202.0, 0)
    assert first.amplitude == pytest.approx(0.3, rel=0.15)
    assert (first.corner, first.damping) == pytest.approx((60.0, 0.4), rel=0.2)


def test_a_wave_that_does_not_depend_on_the_inertia_is_a_plain_ripple() -> None:
    plain = climbed(tuple(upright(number, "plain", 0.08, held=False) for number in range(4)), "current")
    assert names(plain)[:1] == ["Ripple"]
    bare = [names(climbed(tuple(upright(number, ("bare", draw)) for number in range(4)), "current")) for draw in "ab"]
    assert bare == [[], []]


def test_a_wave_is_found_under_friction_that_is_not_explained() -> None:
    """Slow friction builds up at different angles in each direction, which is noise at every order."""
    hidden = Hidden(cogging=(Wave(202.0, 0.08),), presliding=(1.0, 0.05))
    table = Table(trajectories("under friction", hidden, rate=100.0), "current")
    now = fit(table, textbook(table.recordings, "current"))
    assert lines(table, now.residual, 0.005, 1, above=40)[:1] == []
    assert 202.0 in [shapes[0].order for shapes in waves(now, 0.005, {})]


def test_a_wave_is_found_although_a_sharp_resonance_in_few_stretches_is_more_likely() -> None:
    """The wave is the same at all speeds, but for more of it, at another phase, at one speed."""
    more = Wave(200.0, 0.05, 5.25)
    recordings = tuple(
        replace(each, signals={**each.signals, "current": each.signals["current"] + more.at(each.signals["q"])})
        if each.speed.mean() == pytest.approx(SOME[3], rel=0.1) else each
        for each in days("sharp", Hidden(cogging=(Wave(200.0, 0.02),)))
    )  # fmt: skip
    table = Table(recordings, "current")
    now = fit(table, textbook(recordings, "current"))
    sharp = shaped(now, Ripple(order=200.0))
    assert sharp.damping < 0.2
    first = forward_selection(table, SEARCHED).steps[0]
    assert (first.term.order, first.term.power) == (200.0, 0)
    np.testing.assert_allclose(first.term.response(np.array(SOME)), 1, atol=0.05)
    assert gain(now, first.term) < gain(now, sharp)
    # Significant even with five times as many candidates.
    assert first.chance < 0.01


def test_two_effects_are_separated() -> None:
    hidden = Hidden(load=0.01, gravity=0.1)
    ladder = climbed(runs("two", hidden), "current")
    assert set(names(ladder)[:2]) == {"LoadDependentFriction", "GravityError"}
    assert ladder.top.error < 1.05 * fit(Table(runs("two"), "current"), textbook(runs("two"), "current")).error


@pytest.mark.parametrize("draw", range(2))
def test_load_dependent_friction_is_not_found_on_an_axis_without_load(draw: int) -> None:
    """Presliding is largest at reversals, and so is the remaining load, that of inertia."""
    presliding = climbed(runs(draw, Hidden(presliding=(0.3, 0.01)), weight=0.0), "current")
    assert names(presliding)[:1] == ["MaxwellSlip"]
    assert "LoadDependentFriction" not in names(presliding)
    assert "LoadDependentFriction" not in names(climbed(runs(draw, weight=0.0), "current"))


@pytest.mark.parametrize("draw", range(2))
def test_stribeck_friction_is_not_claimed_of_coulomb_and_viscous_friction(draw: int) -> None:
    """Not even if the zero differs from run to run."""
    ladder = climbed(days(("coulomb", draw), Hidden(scatter=0.02)), "current")
    assert names(ladder) == []
    refused = next(trial for trial in ladder.refused if isinstance(trial.term, StribeckFriction))
    assert refused.why


def test_an_effect_of_one_session_alone_is_refused_for_that() -> None:
    here, there = Hidden(ripple=(Wave(200.0, 0.02),)), NOTHING
    mixed = (*days("mixed", there, "AB"), *days("mixed", here, "C"))
    ladder = climbed(mixed, "T_sensor")
    assert names(ladder) == []
    wave = next(trial for trial in ladder.refused if getattr(trial.term, "order", None) == 200.0)
    assert wave.gain > 0
    assert "session" in wave.why


def test_refused_candidates_have_a_reason_and_steps_lower_the_error() -> None:
    ladder = moved_ladder("presliding")
    assert all(trial.why for trial in ladder.refused if not trial.accepted)
    assert all(step.accepted and not step.why for step in ladder.steps)
    fits = [ladder.textbook, *(step.fit for step in ladder.steps)]
    assert all(after.error < before.error for before, after in pairwise(fits))
    assert [len(each.terms) for each in fits] == list(range(3, 3 + len(fits)))
    assert ladder.top is fits[-1]


def test_the_same_recordings_give_the_same_ladder_and_every_step_is_reported() -> None:
    hidden, of, *_ = MOVED["presliding"]
    lines: list[str] = []
    first, again = (
        moved_ladder("presliding"),
        forward_selection(Table(runs("presliding", hidden), of), SEARCHED, lines.append),
    )
    assert again.top.terms == first.top.terms
    assert [trial.term for trial in again.refused] == [trial.term for trial in first.refused]
    assert len(lines) == len(again.steps) + 2 > 2
    assert lines[1].startswith("step 1: + Maxwell slip: error 0.0")
    assert lines[1].endswith(" A on the fitted recordings")


def test_a_library_without_the_effect_does_not_find_it() -> None:
    kinds = [kind for kind in SEARCHED if not kind.__name__.startswith("Load")]
    ladder = forward_selection(Table(runs("load", MOVED["load"][0]), "current"), kinds)
    assert ladder.top.error > 1.2 * moved_ladder("load").top.error


def test_a_single_run_can_be_climbed() -> None:
    one = (steady(0.8, "one", Hidden(ripple=(Wave(200.0, 0.03),)), rate=200.0, seconds=10.0),)
    ladder = climbed(one, "T_sensor")
    assert np.isclose(ladder.steps[0].term.order, 200, atol=1.0)
