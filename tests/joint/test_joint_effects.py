"""Effects on a joint: growth, signs, analytic limits."""

from dataclasses import replace

import numpy as np
import pytest
from joint_fixtures import strain
from scipy.signal import lsim

from swgsim.joint.effects import SEARCHED
from swgsim.joint.effects.friction import (
    AsymmetricFriction,
    LoadViscosity,
    PositionFriction,
    QuadraticFriction,
    StribeckFriction,
    SublinearFriction,
)
from swgsim.joint.effects.load import EncoderEccentricity, GravityError, InertiaError, LoadCurve
from swgsim.joint.effects.ripple import STATED, InertiaRipple, Ripple
from swgsim.joint.effects.slip import LoadDependentFriction, MaxwellSlip
from swgsim.joint.recording import JointRecording
from swgsim.joint.shared import OfLoad
from swgsim.joint.term import Term
from swgsim.joint.textbook import Friction, RigidBody, Zero, textbook

RATE = 100.0
TIME = np.arange(400) / RATE
ALL = [*(kind() for kind in SEARCHED), Ripple(order=8.0), PositionFriction(order=8.0), RigidBody(), Friction(), Zero()]


def recorded(q: np.ndarray, omega: np.ndarray, load: np.ndarray | None = None, rate: float = RATE) -> JointRecording:
    signals = {"q": q, "omega": omega, "T_rigid": np.full(len(q), 10.0) if load is None else load}
    return JointRecording("made up", "robot", "joint", "day", np.arange(len(q)) / rate, signals)


def turning(speed: float, load: float = 10.0) -> JointRecording:
    return recorded(speed * TIME, np.full(len(TIME), speed), np.full(len(TIME), load))


def swing() -> JointRecording:
    phase = 2 * np.pi * TIME / TIME[-1]
    return recorded(np.sin(phase + 0.4), np.pi / 2 * np.cos(phase + 0.4), 10 * np.cos(1.7 * phase))


def name(term: Term) -> str:
    return type(term).__name__


@pytest.mark.parametrize("term", ALL, ids=name)
def test_units_are_those_of_the_columns(term: Term) -> None:
    columns = term.columns(swing())
    assert np.isfinite(columns).all()
    assert len(columns) == len(TIME)
    assert len(term.units("A")) in (1, columns.shape[1])
    assert all(unit.startswith("A") for unit in term.units("A"))
    weights = np.arange(1.0, 1 + columns.shape[1])
    np.testing.assert_allclose(term.weighted(weights).signal(swing()), columns @ weights)


@pytest.mark.parametrize("kind", SEARCHED)
def test_an_effect_needs_the_signals_of_its_columns(kind: type[Term]) -> None:
    whole = swing()
    assert kind().possible(whole)
    bare = replace(whole, signals={name: whole.signals[name] for name in ("q", "omega")})
    assert kind().possible(bare) == ("T_rigid" not in kind.needs and not issubclass(kind, OfLoad))


GROWTH = {
    "speed": [
        (Friction(), (1, 2)),
        (AsymmetricFriction(), (1, 2)),
        (SublinearFriction(power=0.5), (np.sqrt(2),)),
        (SublinearFriction(power=2 / 3), (2 ** (2 / 3),)),
        (QuadraticFriction(), (4,)),
        (LoadViscosity(), (2,)),
    ],
    "load": [(LoadDependentFriction(), (2,)), (LoadViscosity(), (2,)), (LoadCurve(), (4, 8)), (RigidBody(), (2,))],
}


@pytest.mark.parametrize("by", GROWTH)
def test_growth_with_speed_and_load(by: str) -> None:
    once, twice = (turning(0.3 * f) if by == "speed" else turning(0.3, 5.0 * f) for f in (1, 2))
    for term, factors in GROWTH[by]:
        small, large = term.columns(once)[1:], term.columns(twice)[1:]
        np.testing.assert_allclose(large / small, np.tile(factors, (len(small), 1)), rtol=1e-9)


def test_friction_by_load_has_no_sign_of_the_load_and_a_load_curve_has() -> None:
    for term in (LoadDependentFriction(), LoadViscosity()):
        assert not term.columns(turning(0.3, 0.0)).any()
        np.testing.assert_array_equal(term.columns(turning(0.3, -7.0)), term.columns(turning(0.3, 7.0)))
    here = swing()
    mirrored = replace(here, signals={**here.signals, "T_rigid": -here.signals["T_rigid"]})
    np.testing.assert_allclose(LoadCurve().columns(mirrored), -LoadCurve().columns(here))


ODD = (Friction(), SublinearFriction(), QuadraticFriction(), StribeckFriction(), LoadViscosity())
EVEN = (AsymmetricFriction(), LoadCurve(), GravityError(), InertiaError(), Ripple(order=8.0))


@pytest.mark.parametrize("term", [*ODD, PositionFriction(order=8.0), *EVEN], ids=name)
def test_sign_of_the_same_motion_backwards(term: Term) -> None:
    """Friction changes its sign where a motion runs backwards; gravity, inertia and waves do not."""
    forwards, sign = swing(), 1 if term in EVEN else -1
    signals = {name: values[::-1] * (-1 if name == "omega" else 1) for name, values in forwards.signals.items()}
    back = replace(forwards, signals=signals)
    np.testing.assert_allclose(term.columns(back)[::-1], sign * term.columns(forwards), atol=1e-3)


def test_stribeck_friction_is_whole_at_creep_and_gone_at_speed() -> None:
    term = StribeckFriction(v_s=0.2)
    shares = [term.columns(turning(speed))[:, 0].mean() for speed in (0.03, 0.2, 2.0, -0.2)]
    np.testing.assert_allclose(shares, [np.exp(-0.0225), np.exp(-1), 0, -np.exp(-1)], atol=1e-9)


def test_acceleration_of_a_speed_that_is_a_parabola_is_exact() -> None:
    omega = 0.5 * TIME**2 - TIME
    np.testing.assert_allclose(InertiaError().columns(recorded(0 * TIME, omega))[:, 0], TIME - 1, atol=1e-9)


def test_slip_over_a_short_distance_is_the_sense_of_the_motion() -> None:
    here = swing()
    moving = np.abs(np.diff(here.signals["q"], prepend=np.nan)) > 2 * 2e-4
    sense = np.sign(here.signals["omega"])
    slip = MaxwellSlip(distance=2e-4).columns(here)
    np.testing.assert_allclose(slip[moving, 0], sense[moving], atol=1e-9)
    load = LoadDependentFriction(distance=2e-4).columns(here)[:, 0]
    np.testing.assert_allclose(load[moving], (np.abs(here.signals["T_rigid"]) * sense)[moving], atol=1e-9)


def test_slip_is_that_of_a_bristle_and_the_second_element_bends_five_times_as_far() -> None:
    here = swing()
    slip = MaxwellSlip(distance=0.02).columns(here)
    np.testing.assert_allclose(slip[:, 0], strain(here.signals["q"], 0.02), atol=1e-9)
    np.testing.assert_allclose(slip[:, 1], strain(here.signals["q"], 0.1), atol=1e-9)


@pytest.mark.parametrize("distance", [0.002, 0.01, 0.05])
def test_slip_loses_the_area_of_its_loop(distance: float) -> None:
    """A cycle of amplitude A takes 4 (A - distance) by a friction of 1; nothing while it only bends."""
    q = 0.02 * np.sin(2 * np.pi * np.arange(3001) / 1000)
    force = MaxwellSlip(distance=distance).columns(recorded(q, q))[1000:, 0]
    lost = np.sum((force[1:] + force[:-1]) / 2 * np.diff(q[1000:])) / 2
    assert lost == pytest.approx(4 * max(0.02 - distance, 0), abs=2e-4)


@pytest.mark.parametrize("power", [0, 1, 2])
@pytest.mark.parametrize(("corner", "damping"), [(60.0, 0.4), (150.0, 1.2)])
@pytest.mark.parametrize("speed", [0.4, 1.0, -0.7])
def test_ripple_is_what_a_second_order_system_answers(power: int, corner: float, damping: float, speed: float) -> None:
    """At constant speed, against the solution in time; the input is a derivative of the wave, 1 at 100 Hz."""
    fine = 20
    time = np.arange(int(1.0 * 500 * fine)) / (500 * fine)
    q, w, order = speed * time, 2 * np.pi * corner, 200.0
    wave = (1j * order * speed / (2 * np.pi * STATED)) ** power * np.exp(1j * order * q)
    system = ([w**2], [1, 2 * damping * w, w**2])
    answers = [lsim(system, part, time)[1][len(time) // 2 :: fine] for part in (wave.real, wave.imag)]
    here = recorded(q[::fine], np.full(500, speed), rate=500.0)
    term = Ripple(order=order, power=power, corner=corner, damping=damping)
    np.testing.assert_allclose(term.columns(here)[250:], np.stack(answers, axis=1), atol=5e-3 * np.abs(wave).max())


def test_amplitude_and_phase_of_a_ripple() -> None:
    term = Ripple(order=8.0, weights=(3.0, 4.0))
    q = np.linspace(0, 2 * np.pi / 8, 4001)
    wave = term.signal(recorded(q, np.full(len(q), 0.1)))
    assert wave.max() == pytest.approx(term.amplitude, rel=1e-3) == 5.0
    assert 8 * q[wave.argmax()] == pytest.approx(term.phase, abs=5e-3)
    # Without weights: cosine and sine, which an open filter does not change.
    free = np.stack([np.cos(8 * q), np.sin(8 * q)], axis=1)
    np.testing.assert_allclose(term.columns(recorded(q, np.full(len(q), 0.1))), free, atol=2e-4)


def test_position_friction_is_a_wave_with_the_sense_of_the_motion() -> None:
    for speed in (0.3, -0.3):
        here = turning(speed)
        expected = np.sign(speed) * np.stack([np.cos(8 * here.signals["q"]), np.sin(8 * here.signals["q"])], axis=1)
        np.testing.assert_allclose(PositionFriction(order=8.0).columns(here), expected, atol=1e-9)


def test_gravity_error_holds_the_payload_of_a_planar_arm() -> None:
    """Torque at each of two joints of a payload at the tip, and of a payload at the elbow."""
    first, second = np.sin(3 * TIME), 0.5 * np.cos(2 * TIME)
    tip = 0.6 * np.cos(first) + 0.4 * np.cos(first + second + 0.3)
    for own, torque in ((first, tip), (second, 0.4 * np.cos(first + second + 0.3))):
        here = replace(recorded(own, 0 * TIME), posture=np.stack([first, second]))
        columns = GravityError().columns(here)
        left = torque - columns @ np.linalg.lstsq(columns, torque)[0]
        assert np.abs(left).max() < 1e-9


@pytest.mark.parametrize("own", [0, 1])
def test_encoder_eccentricity_holds_the_load_of_an_angle_that_is_read_wrong(own: int) -> None:
    """At each of two joints, to the first order: what is left is e times as small."""
    e, axes = 2e-3, np.stack([np.sin(3 * TIME), 0.5 * np.cos(2 * TIME)])

    def load(axes: np.ndarray) -> np.ndarray:
        first, second = np.cumsum(axes, axis=0)
        return 30 * np.cos(first) * (own == 0) + 20 * np.cos(second + 0.3)

    read = axes + e * np.cos(axes + 0.7) * (np.arange(2) == own)[:, None]
    here = replace(recorded(read[own], np.gradient(read[own], TIME), load(read)), posture=read)
    columns, missed = EncoderEccentricity().columns(here), load(axes) - load(read)
    weights = np.linalg.lstsq(columns, missed)[0]
    np.testing.assert_allclose(weights, -e * np.array([np.cos(0.7), -np.sin(0.7)]), rtol=0.02)
    assert np.abs(missed - columns @ weights).max() < 5 * e * np.abs(missed).max()


def test_encoder_eccentricity_of_one_link_is_two_waves_per_revolution() -> None:
    here = swing()
    q = here.signals["q"]
    here = replace(here, signals={**here.signals, "T_rigid": 10 * np.cos(q)})
    two = np.stack([np.cos(2 * q), np.sin(2 * q), np.ones(len(q))], axis=1)
    columns = EncoderEccentricity().columns(here)
    assert np.abs(columns - two @ np.linalg.lstsq(two, columns)[0]).max() < 1e-6


def test_inertia_about_an_upright_axis_follows_the_reach_of_the_arm() -> None:
    first, second = np.sin(1.1 * TIME), 1.2 * np.cos(1.7 * TIME)
    reach = 0.6 * np.cos(first) + 0.4 * np.cos(first + second)
    J, omega = 2 + 30 * reach**2, 0.8 * np.cos(2.3 * TIME)
    here = replace(
        recorded(np.cumsum(omega) / RATE, omega, np.gradient(J * omega, TIME)), posture=np.stack([first, second])
    )
    np.testing.assert_allclose(here.inertia, J, rtol=0.02)
    # Of a joint that lifts its links there is none, nor of one whose torque is no inertia's.
    assert replace(here, signals={**here.signals, "q": first}).inertia is None
    assert replace(here, signals={**here.signals, "T_rigid": 50 * np.cos(first)}).inertia is None


def test_inertia_ripple_falls_with_the_inertia_and_its_resonance_with_its_root() -> None:
    here = replace(recorded(0.5 * TIME, np.full(len(TIME), 0.5)), posture=np.zeros((1, len(TIME))))
    heavy, light = (replace(here, name=name) for name in ("heavy", "light"))
    for each, inertia in ((heavy, 8.0), (light, 2.0)):
        each.__dict__["inertia"] = np.full(len(TIME), inertia)
    size = {
        (each.name, corner): np.hypot(*InertiaRipple(order=200.0, corner=corner, damping=0.2).columns(each).T).mean()
        for each in (heavy, light) for corner in (2000.0, 45.0)
    }  # fmt: skip
    assert size["light", 2000.0] / size["heavy", 2000.0] == pytest.approx(4)
    # 16 Hz is the resonance of 45 Hz at 8 kg m^2; of 2 kg m^2 it is half of it.
    assert size["heavy", 45.0] * 8 == pytest.approx(1 / 0.4, rel=0.02)
    assert size["light", 45.0] * 2 == pytest.approx(4 / 3, rel=0.05)


BRAKING = (StribeckFriction(), QuadraticFriction(), SublinearFriction(), LoadDependentFriction(), LoadViscosity())


@pytest.mark.parametrize("term", [*BRAKING, MaxwellSlip()], ids=name)
def test_friction_that_drives_is_not_sound(term: Term) -> None:
    wrong, right = ((-0.2, -0.1), (0.1, 0.2)) if isinstance(term, MaxwellSlip) else ((-0.1,), (0.1,))
    assert not term.weighted(np.array(wrong)).has_physical_sign
    assert term.weighted(np.array(right)).has_physical_sign


def test_weights_have_names() -> None:
    assert Friction(weights=(1.0, 2.0)).names() == ("Coulomb friction", "viscous friction")
    assert StribeckFriction(weights=(1.0,)).names() == ("stribeck_friction",)
    of_two_links = GravityError(weights=(1.0, 2.0, 3.0, 4.0)).names()
    assert of_two_links == ("cosine of link 1", "cosine of link 2", "sine of link 1", "sine of link 2")


def test_textbook_takes_the_controllers_model_where_there_is_one() -> None:
    whole = swing()
    bare = replace(whole, signals={name: whole.signals[name] for name in ("q", "omega")})
    assert [name(term) for term in textbook((whole,), "current")] == ["RigidBody", "Friction", "Zero"]
    assert [name(term) for term in textbook((whole,), "T_sensor")] == ["RigidBody", "Friction"]
    assert [name(term) for term in textbook((bare,), "T_sensor")] == ["RigidBody"]
    assert textbook((whole,), "current")[0].columns(whole).shape[1] == 1
    assert textbook((whole, bare), "current")[0].columns(whole).shape[1] == 3
    measured = replace(whole, signals={**whole.signals, "T_sensor": 3 * TIME})
    load, *_ = textbook((measured,), "current", measured=True)
    np.testing.assert_array_equal(load.columns(measured)[:, 0], 3 * TIME)


def test_one_link_without_a_model_or_a_posture() -> None:
    here = turning(0.5)
    q = here.signals["q"]
    expected = np.stack([0 * q, np.cos(q), np.sin(q)], axis=1)
    np.testing.assert_allclose(RigidBody(modelled=False).columns(here), expected, atol=1e-9)
    np.testing.assert_allclose(GravityError().columns(here), expected[:, 1:])


def test_friction_keeps_its_sense_where_a_joint_sticks_on_its_way_and_changes_it_where_it_turns() -> None:
    sticking = 0.5 * (np.arange(len(TIME)) < len(TIME) / 2)
    np.testing.assert_array_equal(recorded(np.cumsum(sticking), sticking).sense(0.01), 1.0)
    here = swing()
    np.testing.assert_allclose(here.sense(0.01), np.tanh(here.signals["omega"] / 0.01), atol=1e-3)
    shifted = here.sense(0.01, lag=5 / RATE)
    np.testing.assert_allclose(shifted[5:], here.sense(0.01)[:-5], atol=1e-9)
    assert Friction(side=-1).columns(here)[:, 0] == pytest.approx(-here.sense(0.01))
