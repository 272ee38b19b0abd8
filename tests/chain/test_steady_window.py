"""A motion that repeats is the same whether one revolution is repeated or all are integrated."""

from dataclasses import fields

import numpy as np
import pytest
from chain_fixtures import GEAR, map_of

from swgsim.chain.chain import evaluate, interpolate
from swgsim.chain.dynamics import Drive
from swgsim.chain.motion import Motion, run
from swgsim.chain.settling import steady_state
from swgsim.chain.steady_window import over_window
from swgsim.effects import EccentricWaveGenerator, InputUnbalance, RootToothCrack, TipToothCrack
from swgsim.gear.gear import KinematicError, OperatingPoint

pytestmark = pytest.mark.end_to_end
POINTS = [OperatingPoint(2000, 7), OperatingPoint(4000, 70)]
DT, SAMPLES = 1e-4, 600
START = np.zeros(2)  # elsewhere the integration begins near the angle only


def both(b3: float, effects=((), ())) -> tuple[Motion, Motion]:
    """The motions of a gear at both points, of which some are repeated, and all of them integrated."""
    drive = Drive([GEAR.with_transmission(b3=b3).transmission] * 2, POINTS, effects)
    return over_window(drive, START, DT, SAMPLES), run(drive, steady_state(drive, START), DT, SAMPLES)


def test_a_repeated_revolution_is_the_integrated_motion() -> None:
    repeated, integrated = both(b3=0.0)
    for field in fields(Motion):
        if field.name != "dt":
            ours, theirs = (getattr(motion, field.name) for motion in (repeated, integrated))
            np.testing.assert_allclose(ours, theirs, rtol=0, atol=2e-6 * np.abs(theirs).max(), err_msg=field.name)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of the motion that diverges
def test_a_motion_that_diverges_in_harmonic_balance_leaves_the_others_alone() -> None:
    calm = GEAR.transmission
    resonant = GEAR.with_transmission(J_out=0.08, kinematic_error=(KinematicError(2, 1.5e-4),)).transmission
    point = OperatingPoint(2000, 7)  # its order 2 meets the resonance at 70 Hz
    alone = over_window(Drive([calm], [point]), START[:1], DT, SAMPLES)
    beside = over_window(Drive([calm, resonant], [point] * 2), START, DT, SAMPLES)
    assert np.isfinite(beside.T_in).all()
    np.testing.assert_allclose(beside.T_out[0], alone.T_out[0], rtol=1e-6)
    assert beside.T_out[1].std() > 10 * beside.T_out[0].std()


def test_the_window_begins_at_the_angle_of_the_trigger() -> None:
    drive, start = Drive([GEAR.transmission] * 2, POINTS), np.array([0.02, -0.7])
    np.testing.assert_allclose(over_window(drive, start, DT, SAMPLES).phi_in[:, 0], start, atol=1e-9)


def test_friction_over_an_output_revolution_is_that_of_the_middle_of_the_window() -> None:
    """It moves the efficiency by far less than any flange resolves, 0.05 N m of 7 N m."""
    repeated, integrated = both(b3=0.07)
    np.testing.assert_allclose(repeated.efficiency, integrated.efficiency, rtol=1e-3)
    assert np.abs(repeated.T_out - integrated.T_out).max() < 0.02


def test_a_window_in_which_friction_over_an_output_revolution_changes_is_integrated() -> None:
    drive, samples = Drive([GEAR.transmission] * 2, POINTS), 2000  # up to 13 revolutions
    integrated = run(drive, steady_state(drive, START), DT, samples)
    np.testing.assert_array_equal(over_window(drive, START, DT, samples).T_in, integrated.T_in)


def test_a_drive_with_effects_is_integrated() -> None:
    one, other = both(0.0, effects=((InputUnbalance(0.01, 0.0),), ()))
    alone = Drive([GEAR.with_transmission(b3=0.0).transmission], POINTS[:1], [(InputUnbalance(0.01, 0.0),)])
    integrated = run(alone, steady_state(alone, START[:1]), DT, SAMPLES)
    np.testing.assert_array_equal(one.T_in[0], integrated.T_in[0])
    assert np.abs(one.T_in[0] - both(0.0)[0].T_in[0]).max() > 1e-3
    np.testing.assert_allclose(one.T_in[1], other.T_in[1], atol=1e-6)


@pytest.mark.parametrize(
    "effects", [(), (EccentricWaveGenerator(1e-4, 0.3),), (RootToothCrack(0.01, 1.0),), (TipToothCrack(1.0, 2.0),)]
)
def test_signals_between_the_angles_of_a_map_are_those_of_its_orders(effects) -> None:
    psi = np.random.default_rng(0).uniform(-1, 30, 700)
    T_out = 40 + np.sin(psi)
    given = [map_of(*effects)]
    exact = evaluate(given, psi, T_out)
    np.testing.assert_allclose(interpolate(given, psi, T_out), exact, rtol=0, atol=1e-7 * np.abs(exact).max())
