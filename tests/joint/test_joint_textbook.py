"""The textbook model: sign of the friction, signs that are possible, the measured torque, and the side of the gear."""

from dataclasses import replace

import numpy as np
import pytest
from joint_fixtures import COULOMB, PER_TORQUE, VISCOUS, Hidden, coloured, trajectories

from swgsim.common.seeds import generator
from swgsim.joint.cautions import cautions
from swgsim.joint.effects import SEARCHED
from swgsim.joint.effects.friction import StribeckFriction
from swgsim.joint.effects.load import EncoderEccentricity, GravityError, LoadCurve
from swgsim.joint.effects.slip import LoadDependentFriction, MaxwellSlip
from swgsim.joint.ladder import Ladder, forward_selection
from swgsim.joint.low_speed import in_sum
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Table, fit, rms
from swgsim.joint.report import report
from swgsim.joint.textbook import Friction, RigidBody, Stiction, fitted_textbook, textbook, wrong_signs
from swgsim.joint.validation import Validation

NOISE = 0.03


def moved(seed: object, width: float, slower: float = 1.0, doubt: float = 2e-3) -> tuple[JointRecording, ...]:
    """Load, Coulomb friction whose sign has a width [rad/s] (0: sharp) and viscous friction; nothing else."""
    recordings = []
    for number, each in enumerate(trajectories(seed, rate=50.0)):
        rng = generator("moved", seed, number)
        time, q = slower * each.time, each.signals["q"]
        omega, load = np.gradient(q, time), each.signals["T_rigid"]
        sign = np.tanh(omega / width) if width else np.sign(omega)
        current = PER_TORQUE * load + COULOMB * sign + VISCOUS * omega + coloured(rng, len(q), each.rate, NOISE)
        signals = {**each.signals, "omega": omega + doubt * rng.normal(size=len(q)), "current": current}
        recordings.append(replace(each, time=time, signals=signals))
    return tuple(recordings)


def width_of(table: Table) -> float:
    return next(term.sign_width for term in fitted_textbook(table).terms if isinstance(term, Friction))


@pytest.mark.end_to_end
@pytest.mark.parametrize("width", [0.0, 0.004, 0.01])
@pytest.mark.parametrize("slower", [1.0, 4.0])
def test_nothing_is_missing_however_sharply_coulomb_friction_turns(width: float, slower: float) -> None:
    table = Table(moved(("sharp", width, slower), width, slower), "current")
    ladder = forward_selection(table, SEARCHED)
    assert [type(step.term).__name__ for step in ladder.steps] == []


def test_the_width_of_the_sign_is_fitted_and_not_below_the_doubt_of_the_speed() -> None:
    assert width_of(Table(moved("wide", 0.01, 4.0), "current")) == pytest.approx(0.01, rel=0.2)
    sharp = moved("doubt", 0.0, 4.0, doubt=0.01)
    doubts = [each.speed_doubt for each in sharp]
    # Smoothing leaves some of the noise.
    assert all(0.2 < doubt / 0.01 < 0.9 for doubt in doubts)
    assert width_of(Table(sharp, "current")) >= 0.99 * np.sqrt(np.mean(np.square(doubts)))


def test_the_lag_of_the_current_is_fitted_and_is_no_effect() -> None:
    late = tuple(
        replace(
            each, signals={**each.signals, "current": np.interp(each.time - 0.012, each.time, each.signals["current"])}
        )
        for each in moved("late", 0.0, 4.0)
    )
    table = Table(late, "current")
    ladder = forward_selection(table, SEARCHED)
    assert ladder.steps == ()
    assert not any("at its bound" in each for each in cautions(Validation(ladder, table, None), []))
    (friction,) = (term for term in ladder.top.terms if isinstance(term, Friction))
    assert friction.lag == pytest.approx(0.012, abs=0.008)


def test_a_lag_at_its_bound_is_a_caution() -> None:
    table = Table(moved("bound", 0.01, 0.5), "current")
    start = fitted_textbook(table)
    for lag, said in ((0.02, True), (-0.02, True), (0.015, False)):
        terms = tuple(replace(term, lag=lag) if hasattr(term, "lag") else term for term in start.terms)
        validation = Validation(Ladder(fit(table, terms), (), ()), table, None)
        assert any("at its bound of 20 ms" in each for each in cautions(validation, [])) == said


def stopping(seed: object, part: float) -> tuple[JointRecording, ...]:
    """A joint that moves, stands and moves again; at rest a part of its Coulomb friction holds it."""
    recordings = []
    for number, each in enumerate(moved(seed, 0.01)):
        rng = generator("stopping", seed, number)
        shape = np.tile(np.repeat(rng.choice([-0.4, 0.4], 25), 50), 2)[: len(each)]
        stands = np.arange(len(each)) % 100 >= 50
        omega = np.where(stands, 0.0, shape * np.sin(np.pi * (np.arange(len(each)) % 50) / 50))
        q, sign = np.cumsum(omega) / each.rate, np.where(stands, 0.0, np.sign(omega))
        last = np.where(np.arange(len(each)) >= 50, np.sign(shape[np.maximum(np.arange(len(each)) - 50, 0)]), 0.0)
        load = 40 * np.cos(q)
        friction = COULOMB * (sign + part * np.where(stands, last, 0.0)) + VISCOUS * omega
        signals = {
            "q": q, "omega": omega + 1e-3 * rng.normal(size=len(q)), "T_rigid": load,
            "current": PER_TORQUE * load + friction + NOISE * rng.normal(size=len(q)),
        }  # fmt: skip
        recordings.append(replace(each, signals=signals))
    return tuple(recordings)


def test_friction_that_holds_a_joint_at_rest_belongs_to_the_textbook() -> None:
    found = fitted_textbook(Table(stopping("rest", 0.6), "current"))
    (rest,) = (term for term in found.terms if isinstance(term, Stiction))
    assert rest.weights[0] == pytest.approx(0.6 * COULOMB, rel=0.1)
    assert found.error < 2 * NOISE
    assert not any(isinstance(term, Stiction) for term in textbook(moved("rest", 0.01), "current"))


def test_effects_with_a_sign_have_the_width_of_the_textbook() -> None:
    start = fitted_textbook(Table(moved("shared", 0.0, 4.0), "current"))
    (friction,) = (term for term in start.terms if isinstance(term, Friction))
    assert StribeckFriction().added_to(start.terms).sign_width == friction.sign_width != StribeckFriction().sign_width


def test_a_textbook_that_cannot_be_is_bounded_and_its_wrong_sign_is_said() -> None:
    """A current whose sign is the opposite of the velocity's: friction would drive."""
    reversed_ = tuple(
        replace(each, signals={**each.signals, "omega": -each.signals["omega"], "q": -each.signals["q"]})
        for each in moved("signs", 0.01)
    )
    found = fitted_textbook(Table(reversed_, "current"))
    (friction,) = (term for term in found.terms if isinstance(term, Friction))
    assert friction.weights == (0.0, 0.0)
    said = list(wrong_signs(found, "A"))
    assert [line.split(" (")[0] for line in said] == ["Coulomb friction", "viscous friction"]
    assert list(wrong_signs(fitted_textbook(Table(moved("signs", 0.01), "current")), "A")) == []
    # Held-out groups are predicted with the same bounds.
    free = fit(found.table, found.terms, bounded=False)
    assert rms(found.unseen) > 1.5 * rms(free.unseen)


def test_bounded_weights_are_the_best_possible_ones() -> None:
    found = fitted_textbook(Table(moved("best", 0.01), "current"))
    y = found.table.signal - 1.2 * found.X[:, 1] * COULOMB
    recordings = tuple(
        replace(each, signals={**each.signals, "current": y[found.table.run == number]})
        for number, each in enumerate(found.table.recordings)
    )
    bounded = fit(Table(recordings, "current"), found.terms)
    assert bounded.weights[1] == 0
    others = np.delete(found.X, 1, axis=1)
    best = np.linalg.lstsq(others, y)[0]
    np.testing.assert_allclose(np.delete(bounded.weights, 1), best, rtol=1e-6, atol=1e-9)
    assert bounded.basis.shape[1] == 3


def with_sensor(zero: float, load: float = 1.0) -> tuple[JointRecording, ...]:
    """The torque that the joint carries was measured; the model of the robot knows ``load`` of it."""
    found = []
    for number, each in enumerate(moved("sensor", 0.01)):
        rng = generator("with sensor", number)
        torque = each.signals["T_rigid"] + 5 * np.sin(1.3 * each.time + number)
        signals = {**each.signals, "T_rigid": load * each.signals["T_rigid"]}
        signals["current"] = each.signals["current"] + PER_TORQUE * (torque - each.signals["T_rigid"])
        signals["T_sensor"] = torque + zero * rng.normal() + 0.05 * rng.normal(size=len(torque))
        found.append(replace(each, signals=signals))
    return tuple(found)


def test_the_measured_torque_is_the_load_of_a_current() -> None:
    table = Table(with_sensor(0.0), "current")
    found = fitted_textbook(table)
    assert found.terms[0].measured
    assert found.terms[0].weights[0] == pytest.approx(PER_TORQUE, rel=0.02)
    assert found.error < 1.1 * NOISE < fit(table, textbook(table.recordings, "current")).error / 5
    # Errors of the rigid-body model have no meaning then.
    asked = {
        type(trial.term)
        for trial in forward_selection(table, (GravityError, EncoderEccentricity, StribeckFriction)).refused
    }
    assert GravityError not in asked
    assert StribeckFriction in asked


def test_a_sensor_that_shows_little_but_its_zero_is_not_the_load() -> None:
    recordings = tuple(
        replace(each, signals={**each.signals, "T_sensor": np.full(len(each), 0.2 * number)})
        for number, each in enumerate(moved("zero", 0.01))
    )
    (load, *_) = fitted_textbook(Table(recordings, "current")).terms
    assert isinstance(load, RigidBody)
    assert not load.measured


@pytest.mark.parametrize("side", [1, -1, 0])
def test_friction_is_found_between_a_torque_sensor_and_the_torque_of_the_other_side(side: int) -> None:
    """The sensor sees more than the links need, or less than the motor gives; or both are on one side."""
    recordings = []
    for number, each in enumerate(moved("sides", 0.01)):
        omega = np.gradient(each.signals["q"], each.time)
        torque = each.signals["T_rigid"] + side * (4 * np.tanh(omega / 0.01) + 5 * omega)
        torque = torque + coloured(generator("side", number), len(omega), each.rate, 0.3)
        recordings.append(replace(each, signals={**each.signals, "T_sensor": torque}))
    found = fitted_textbook(Table(tuple(recordings), "T_sensor"))
    (friction,) = (term for term in found.terms if isinstance(term, Friction))
    expected = (4, 5) if side else (0, 0)
    assert friction.weights == pytest.approx(expected, abs=0.15)
    assert not side or friction.side == side


def test_a_motor_torque_is_explained_as_a_current_is() -> None:
    recordings = moved("drive", 0.005)
    named = tuple(
        replace(each, signals={**each.signals, "T_motor": 8.0 * each.signals["current"]}) for each in recordings
    )
    of_current, of_torque = (fitted_textbook(Table(named, of)) for of in ("current", "T_motor"))
    assert [type(term) for term in of_torque.terms] == [type(term) for term in of_current.terms]
    for one, other in zip(of_torque.terms, of_current.terms, strict=True):
        np.testing.assert_allclose(one.weights, 8.0 * np.array(other.weights), rtol=1e-6, atol=1e-6)


def without_rigid(recordings: tuple[JointRecording, ...], moves: float = 1.0, about: float = 0.0) -> Table:
    """The joint moves by a part of its way, about another angle, and has no model torque."""
    found = []
    for each in recordings:
        kept = {name: values for name, values in each.signals.items() if name != "T_rigid"}
        q, omega = each.signals["q"], each.signals["omega"]
        near = moves * q + about
        change = PER_TORQUE * 40 * (np.cos(near) - np.cos(q))
        kept |= {"q": near, "omega": moves * omega, "current": each.signals["current"] + change}
        found.append(replace(each, signals=kept))
    return Table(tuple(found), "current")


def test_the_load_of_the_textbooks_own_link_shows_load_dependent_friction() -> None:
    table = without_rigid(trajectories("link", Hidden(load=0.02), rate=50.0))
    ladder = forward_selection(table, (LoadDependentFriction, LoadCurve))
    (step,) = ladder.steps
    assert isinstance(step.term, LoadDependentFriction)
    assert step.term.weights[0] == pytest.approx(0.02 / PER_TORQUE, rel=0.1)
    assert step.term.units("A") == ("A/A",)
    assert [type(term) for term in ladder.unsearched] == [LoadCurve]


def test_a_joint_that_moves_near_one_angle_does_not_give_its_load() -> None:
    ladder = forward_selection(without_rigid(trajectories("near", rate=50.0), 0.02, 0.8), (LoadDependentFriction,))
    assert [type(term) for term in ladder.unsearched] == [LoadDependentFriction]
    assert ladder.steps == ()
    said = report(Validation(ladder, ladder.top.table, None), None, [])
    assert "not searched, needs T_rigid: load dependent friction" in said["sentence"]


def test_friction_in_sum_is_known_better_than_its_parts() -> None:
    recordings = trajectories("sum", Hidden(presliding=(0.3, 2e-3)), rate=50.0)
    start = fitted_textbook(Table(recordings, "current"))
    top = fit(start.table, (*start.terms, MaxwellSlip(distance=1e-3)))
    (total,) = in_sum(top, "A").values()
    assert total["value"] == pytest.approx(COULOMB + 0.3, rel=0.03)
    coulomb = next(i for i, term in enumerate(top.terms) if isinstance(term, Friction))
    alone = float(top.half_interval[sum(len(term.weights) for term in top.terms[:coulomb])])
    assert total["ci95"][1] - total["value"] < 0.5 * alone
    assert in_sum(start, "A") == {}
