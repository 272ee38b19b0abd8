"""Inner parameters of joint effects, found beside the textbook's terms."""

from dataclasses import replace

import numpy as np
import pytest
from joint_fixtures import Hidden, Wave, sessions, trajectories

from swgsim.joint.effects.friction import QuadraticFriction, StribeckFriction, SublinearFriction
from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.effects.slip import LoadDependentFriction, MaxwellSlip
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Fit, Table, fit
from swgsim.joint.shaping import gain, shaped
from swgsim.joint.term import Term
from swgsim.joint.textbook import Friction, textbook


def textbook_fit(recordings: tuple[JointRecording, ...], of: str) -> Fit:
    return fit(Table(recordings, of), textbook(recordings, of))


def found(now: Fit, term: Term, true: Term) -> Term:
    """The shaped term, which explains no less than the true one."""
    best = shaped(now, term)
    assert gain(now, best) > 0.998 * gain(now, true)
    return best


@pytest.mark.parametrize("distance", [1e-3, 5e-3, 3e-2])
def test_distance_over_which_friction_builds_up(distance: float) -> None:
    runs = trajectories("distance", Hidden(presliding=(0.3, distance)))
    term = found(textbook_fit(runs, "current"), MaxwellSlip(), MaxwellSlip(distance=distance))
    # Long distances may as well be those of the second element.
    assert min(abs(np.log(term.distance * share / distance)) for share in (1, 5)) < 0.1


def test_distance_at_which_flanks_slide() -> None:
    runs = trajectories("flanks", Hidden(load=0.02))
    term = found(textbook_fit(runs, "current"), LoadDependentFriction(distance=0.05), LoadDependentFriction())
    assert term.distance == pytest.approx(2e-3, rel=0.1)


@pytest.mark.parametrize("v_s", [0.06, 0.15, 0.3])
def test_stribeck_speed(v_s: float) -> None:
    runs = sessions("stribeck", Hidden(stribeck=(0.2, v_s)), rate=100.0)
    term = found(textbook_fit(runs, "current"), StribeckFriction(), StribeckFriction(v_s=v_s))
    assert term.v_s == pytest.approx(v_s, rel=0.1)


def test_power_of_sublinear_friction() -> None:
    runs = sessions("sublinear", Hidden(sublinear=3.0), rate=100.0)
    term = found(textbook_fit(runs, "current"), SublinearFriction(power=0.3), SublinearFriction())
    assert term.power == pytest.approx(2 / 3, abs=0.1)


@pytest.mark.parametrize(("corner", "damping"), [(40.0, 0.3), (35.0, 0.7), (80.0, 0.2)])
def test_corner_and_damping_of_a_resonance(corner: float, damping: float) -> None:
    """Waves at 22 to 111 Hz, past the resonance."""
    hidden = Hidden(ripple=(Wave(700.0, 0.05),), corner=corner, damping=damping)
    runs = sessions("resonance", hidden, names="A", seconds=3.0)[3:]
    now = textbook_fit(runs, "T_sensor")
    term = found(now, Ripple(order=700.0), Ripple(order=700.0, corner=corner, damping=damping))
    assert term.power == 0
    assert term.corner == pytest.approx(corner, rel=0.03)
    assert term.damping == pytest.approx(damping, rel=0.1)
    wave = fit(now.table, (*now.terms, term)).terms[-1]
    assert (wave.amplitude, wave.phase) == pytest.approx((0.05, 0.7), rel=0.1)


def test_a_wave_without_a_filter_is_given_none() -> None:
    runs = sessions("open", Hidden(ripple=(Wave(200.0, 0.05),)), names="A", rate=200.0)
    term = found(textbook_fit(runs, "T_sensor"), Ripple(order=200.0), Ripple(order=200.0))
    assert term.power == 0
    reached = np.array([0.3, 1.0])
    np.testing.assert_allclose(term.response(reached), [1, 1], atol=0.05)


def test_gain_is_what_a_fit_gains() -> None:
    runs = trajectories("gain", Hidden(quadratic=0.5), rate=50.0)
    now = textbook_fit(runs, "current")
    added = fit(now.table, (*now.terms, QuadraticFriction()))
    assert gain(now, QuadraticFriction()) == pytest.approx(now.error**2 - added.error**2, rel=1e-6)
    assert gain(now, Friction()) == pytest.approx(0, abs=1e-12)  # it is there already


def test_parameters_stay_within_their_bounds_and_those_of_one_value_stay() -> None:
    runs = sessions("bounds", Hidden(stribeck=(0.2, 2.0)), names="A", rate=100.0)
    term = shaped(textbook_fit(runs, "current"), StribeckFriction())
    assert 0.02 <= term.v_s <= 0.5
    runs = sessions("bounds", Hidden(ripple=(Wave(8.0, 0.05),)), names="A", rate=100.0)
    wave = shaped(textbook_fit(runs, "T_sensor"), Ripple(order=8.3))
    assert wave.order == 8.3
    assert replace(wave, weights=()) == wave
