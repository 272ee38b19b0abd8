"""The input/output model: energy, limits, convergence, agreement with solve_ivp."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from swgsim.chain.dynamics import OMEGA_IN, OMEGA_OUT, PHI_IN, PHI_OUT, SPEED_ERROR, Drive
from swgsim.chain.equilibrium import uniform_rotation
from swgsim.chain.motion import advance, run, shooting, steps_per_revolution
from swgsim.chain.settling import steady_state
from swgsim.effects.input_unbalance import InputUnbalance
from swgsim.gear.gear import KinematicError, OperatingPoint, Transmission
from swgsim.studies.benchmark import integrator_vs_solve_ivp

NOMINAL = Transmission()
POINTS = tuple(OperatingPoint(n, T) for n in (2000, 4000) for T in (7, 39, 70))
FRICTIONLESS = replace(NOMINAL, b0=0, b1=0, b2=0, b3=0, mu=0)


@pytest.mark.end_to_end
def test_without_friction_the_efficiency_is_one() -> None:
    drive = Drive([FRICTIONLESS] * 6, POINTS)
    assert run(drive, steady_state(drive), 1e-4, 600).efficiency == pytest.approx(1, abs=1e-6)


@pytest.mark.end_to_end
def test_efficiency_of_uniform_rotation_in_closed_form() -> None:
    """With no kinematic error, eta = T / (T + T_fric / sin a), T_fric = (B + mu T / cos a) / (1 - mu tan a)."""
    t = replace(NOMINAL, kinematic_error=(), b3=0.0)
    drive = Drive([t] * 6, POINTS)
    measured = run(drive, steady_state(drive), 1e-4, 600).efficiency
    for point, value in zip(POINTS, measured, strict=True):
        sliding = point.omega_in / (t.N + 1) / np.sin(t.alpha_tooth)
        friction = (t.b0 + t.b1 * sliding + t.mu * point.T_out / np.cos(t.alpha_tooth)) / (
            1 - t.mu * np.tan(t.alpha_tooth)
        )
        assert value == pytest.approx(point.T_out / (point.T_out + friction / np.sin(t.alpha_tooth)), rel=1e-6)


@pytest.mark.end_to_end
def test_energy_balance_closes() -> None:
    """Input work is output work, friction heat, and the change of kinetic, elastic energy, along a transient."""
    t = replace(NOMINAL, b2=-1e-3)  # friction that grows less than linearly
    drive = Drive([t], [POINTS[1]])
    state = steady_state(drive)
    state[OMEGA_OUT] *= 1.02  # off the steady state, so that stored energy changes
    dt, steps = 2e-5, 3000
    power, energy = [], []
    for _ in range(steps + 1):
        torques = drive.torques(state)
        heat = torques.T_fric * torques.sliding
        power.append((torques.T_in * state[OMEGA_IN] - drive.T_load * state[OMEGA_OUT] - heat)[0])
        twist = drive.tan_in * state[PHI_IN] - state[PHI_OUT] / drive.tan_t + drive.phi_err(state[PHI_IN])[0]
        elastic = 0.5 * t.k1 * twist**2 + 0.25 * t.k2 * twist**4
        energy.append((0.5 * t.J_in * state[OMEGA_IN] ** 2 + 0.5 * t.J_out * state[OMEGA_OUT] ** 2 + elastic)[0])
        state = drive.step(state, torques, np.array([dt]))
    work = np.trapezoid(power, dx=dt)
    assert energy[-1] - energy[0] == pytest.approx(work, abs=1e-5 * np.ptp(energy))
    assert np.ptp(energy) > 1e-3


@pytest.mark.parametrize(
    ("share", "flange", "before", "behind"),
    [("load_share", "T_flange", "T_out", "T_load"), ("rotor_share", "T_in", "T_motor", "T_wedge")],
)
def test_a_flange_feels_no_more_of_an_inertia_than_lies_before_it(
    share: str, flange: str, before: str, behind: str
) -> None:
    """It feels the torque behind all of the inertia, which has no ripple at the output. The motion is the same."""
    drives = [Drive([replace(NOMINAL, **{share: value})], [POINTS[1]]) for value in (0.0, 0.4, 1.0)]
    state = steady_state(drives[0])
    torques = [drive.torques(state) for drive in drives]
    felt = [getattr(each, flange) for each in torques]
    assert felt[0] == getattr(torques[0], before) != getattr(torques[0], behind)
    assert felt[2] == pytest.approx(getattr(torques[2], behind))
    assert felt[1] == pytest.approx(0.6 * felt[0] + 0.4 * felt[2])
    rates = [drive.derivative(state, each) for drive, each in zip(drives, torques, strict=True)]
    np.testing.assert_array_equal(rates[0], rates[2])


@pytest.mark.end_to_end
def test_the_rotor_changes_the_ripple_of_the_input_flange_and_not_its_mean() -> None:
    drives = [Drive([replace(NOMINAL, rotor_share=share)], [POINTS[1]]) for share in (0.0, 1.0)]
    state = steady_state(drives[0])
    none, all_of_it = (run(drive, state, drive.period[0] / 200, 200).T_in[0, :-1] for drive in drives)
    assert all_of_it.mean() == pytest.approx(none.mean(), rel=1e-3)
    assert np.ptp(all_of_it) != pytest.approx(np.ptp(none), rel=0.01)


def test_an_error_without_a_lever_brakes_as_a_gear_without_one_does() -> None:
    drive = Drive([replace(NOMINAL, error_lever=0.0)], [POINTS[1]])
    torques = drive.torques(steady_state(drive))
    assert torques.T_wedge == pytest.approx(drive.tan_in * torques.T_stiff)


@pytest.mark.end_to_end
def test_a_steady_state_that_rounding_keeps_from_settling_further_is_one() -> None:
    drive = Drive([NOMINAL], [POINTS[1]])
    found, converged = shooting(drive, tolerance=0.0)
    assert converged.all()
    np.testing.assert_allclose(found, steady_state(drive), rtol=1e-6, atol=1e-9)


@pytest.mark.end_to_end
def test_steady_state_is_where_a_long_transient_ends() -> None:
    point = POINTS[4]
    # b3 varies over an output revolution: there is a strictly periodic state only without it.
    drive = Drive([replace(NOMINAL, b3=0.0)], [point])
    state = steady_state(drive)
    start = uniform_rotation(drive)[:, 0]

    def rate(_: float, y: np.ndarray) -> np.ndarray:
        return drive.derivative(y[:, None], drive.torques(y[:, None]))[:, 0]

    revolutions = 150
    end = solve_ivp(rate, (0, revolutions * drive.period[0]), start, "DOP853", rtol=1e-9, atol=1e-11).y[:, -1]
    # The transient may end at another phase; compare after turning on to phi_in = 0 of the next revolution.
    passes = [lambda _, y, k=revolutions + 1: y[PHI_IN] - 2 * np.pi * k]
    passes[0].terminal = True
    end = solve_ivp(rate, (0, 3 * drive.period[0]), end, "DOP853", events=passes, rtol=1e-9, atol=1e-11).y[:, -1]
    assert end[OMEGA_IN] == pytest.approx(state[OMEGA_IN, 0], rel=1e-6)
    assert end[OMEGA_OUT] == pytest.approx(state[OMEGA_OUT, 0], rel=1e-5)
    assert end[SPEED_ERROR] == pytest.approx(state[SPEED_ERROR, 0], rel=1e-5)


@pytest.mark.slow
def test_integrator_agrees_with_solve_ivp() -> None:
    assert integrator_vs_solve_ivp([NOMINAL] * 20, POINTS[:2])["max_relative_error"] < 1e-6


@pytest.mark.end_to_end
def test_integrator_converges_at_fourth_order() -> None:
    drive = Drive([NOMINAL], [POINTS[4]])
    start = steady_state(drive)
    ends = []
    for steps in (25, 50, 100):
        state = start.copy()
        for _ in range(steps):
            state = drive.step(state, drive.torques(state), drive.period / steps)
        ends.append(state[OMEGA_OUT, 0])
    assert np.log2(abs(ends[0] - ends[1]) / abs(ends[1] - ends[2])) == pytest.approx(4, abs=0.4)


@pytest.mark.end_to_end
def test_b1_is_set_to_claim_c6() -> None:
    """One third less b1 raises the efficiency by 7 %, relative, in the mean over the paper's operating points."""
    less = replace(NOMINAL, b1=2 / 3 * NOMINAL.b1)
    drive = Drive([NOMINAL] * 6 + [less] * 6, POINTS * 2)
    healthy, reduced = run(drive, steady_state(drive), 1e-4, 600).efficiency.reshape(2, 6)
    assert np.mean(reduced / healthy - 1) == pytest.approx(0.07, abs=5e-4)


@pytest.mark.end_to_end
def test_speed_is_controlled_to_the_set_point() -> None:
    drive = Drive([NOMINAL] * 6, POINTS)
    motion = run(drive, steady_state(drive), 1e-4, 600)
    np.testing.assert_allclose(motion.omega_in[:, :600].mean(axis=1), [p.omega_in for p in POINTS], rtol=1e-4)
    np.testing.assert_allclose(motion.T_out[:, :600].mean(axis=1), [p.T_out for p in POINTS], rtol=1e-2)


@pytest.mark.parametrize("own", [(0, 1), (0, 2), (0, 0, 2)], ids=["together", "apart", "twice in one"])
def test_an_effect_acts_on_its_own_runs_alone(own: tuple[int, ...]) -> None:
    effects = [(InputUnbalance(1e-3),) * own.count(i) for i in range(3)]
    without, acted = (Drive([NOMINAL] * 3, POINTS[:3], each) for each in ((), effects))
    state = steady_state(without)
    apart = advance(acted, state, np.full(3, 1.0)) - advance(without, state, np.full(3, 1.0))
    assert tuple(np.flatnonzero(apart.any(axis=0))) == tuple(dict.fromkeys(own))


@pytest.mark.slow
@pytest.mark.end_to_end
@pytest.mark.parametrize("n_in_rpm", [100, 2000])
def test_steady_state_repeats_at_any_speed(n_in_rpm: float) -> None:
    """One revolution on, with steps twice as fine, the state is the same."""
    drive = Drive([replace(NOMINAL, b3=0.0)], [OperatingPoint(n_in_rpm, 39)])
    start = state = steady_state(drive)
    steps = 2 * steps_per_revolution(drive)
    speeds = []
    for _ in range(steps):
        state = drive.step(state, drive.torques(state), drive.period / steps)
        speeds.append(state[OMEGA_OUT, 0])
    assert abs(state[OMEGA_OUT, 0] - start[OMEGA_OUT, 0]) < 1e-4 * np.ptp(speeds)


@pytest.mark.end_to_end
def test_a_large_start_angle_is_reached_along_the_motion() -> None:
    drive = Drive([replace(NOMINAL, b3=0.0)], [POINTS[4]])
    whole = run(drive, steady_state(drive), 1e-4, 600)
    later = run(drive, advance(drive, steady_state(drive), np.array([np.pi])), 1e-4, 100)
    at = np.interp(later.phi_in[0], whole.phi_in[0], whole.T_out[0])
    np.testing.assert_allclose(later.T_out[0], at, atol=2e-3 * np.ptp(whole.T_out))


def test_too_stiff_or_too_slow_names_the_resonance() -> None:
    drive = Drive([replace(NOMINAL, J_out=1e-6)], [OperatingPoint(100, 39)])
    with pytest.raises(ValueError, match=r"100 rpm with a resonance of .* Hz needs .* limit 20000"):
        steady_state(drive)


def test_window_shorter_than_a_revolution_has_no_efficiency() -> None:
    drive = Drive([NOMINAL], [POINTS[0]])
    with pytest.raises(ValueError, match=r"window of 0\.33.. revolutions.*lengthen"):
        _ = run(drive, steady_state(drive), 1e-4, 100).efficiency


@pytest.mark.parametrize(
    ("make", "message"),
    [
        *((partial(replace, NOMINAL, **{name: value}), f"{name} of the transmission is {value!r}") for name, value in (
            ("k1", -1.0), ("J_out", 0.0), ("b1", -0.1), ("mu", np.nan), ("b2", np.inf))),
        *((partial(KinematicError, *term), "of the kinematic error is") for term in (
            (0, 1e-4), (-2, 1e-4), (2, np.nan), (2, -1e-4))),
        *((partial(OperatingPoint, *point), "must be a finite number from") for point in (
            (0, 39), (8000, 39), (2000, -1), (2000, 200), (np.nan, 39))),
    ],
)  # fmt: skip
def test_values_beyond_physical_limits_are_named(make: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()


def test_gears_and_points_must_match() -> None:
    with pytest.raises(ValueError, match="1 gears and 2 operating points"):
        Drive([NOMINAL], list(POINTS[:2]))
