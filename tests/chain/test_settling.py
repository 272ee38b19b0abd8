"""Every gear that can exist has a steady motion: also close to the resonance with little load, and where it hunts."""

from dataclasses import replace

import numpy as np
import pytest
from jaxtyping import Complex
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from swgsim.chain import settling, unsteady
from swgsim.chain.dynamics import OMEGA_IN, PHI_IN, PHI_OUT, Drive, State
from swgsim.chain.equilibrium import resonance, uniform_rotation
from swgsim.chain.motion import Motion, NoSteadyState, run, shooting
from swgsim.chain.newton import LEAST_TIMES, stable_revolution
from swgsim.chain.settling import steady_revolution, steady_state
from swgsim.chain.unsteady import Averaged, mean_revolution
from swgsim.common.seeds import generator
from swgsim.gear.gear import OperatingPoint, Transmission

pytestmark = pytest.mark.end_to_end
NOMINAL = Transmission()
POINTS = 64
Case = tuple[Transmission, OperatingPoint]
Lines = Complex[np.ndarray, "*case order"]
# No fast method finds these: teeth lift at the resonance with order 2 or 1.
LIFTING: list[Case] = [
    (replace(NOMINAL, k1=1.2 * NOMINAL.k1, b1=0.7 * 1.2 * NOMINAL.b1, J_out=0.1), OperatingPoint(2000, 7)),
    (replace(NOMINAL, b1=0.4 * NOMINAL.b1, J_out=0.02), OperatingPoint(4000, 7)),
    (replace(NOMINAL, k1=2.05 * NOMINAL.k1, b1=0.82 * NOMINAL.b1, J_out=0.449, control_frequency=1.76),
     OperatingPoint(1356, 9.3)),
    (replace(NOMINAL, k1=0.57 * NOMINAL.k1, b1=0.94 * NOMINAL.b1, J_out=0.294, control_frequency=1.04),
     OperatingPoint(848, 1.1)),
]  # fmt: skip
# Its speed control of 0.7 Hz hunts with the resonance.
HUNTING: Case = (
    replace(NOMINAL, k1=2.48 * NOMINAL.k1, b1=0.69 * NOMINAL.b1, J_out=0.317, control_frequency=0.71),
    OperatingPoint(841, 19.5),
)


def drawn(rng: np.random.Generator, count: int, resonant: bool, slowest: float = 0.5) -> list[Case]:
    """Gears over the whole range, with a speed control of at least ``slowest`` [Hz].

    If asked, they are weakly damped and their resonances are close to an order of the kinematic error.
    """
    cases: list[Case] = []

    def between(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    while len(cases) < count:
        gear = replace(
            NOMINAL,
            k1=between(0.3, 3) * NOMINAL.k1,
            b1=between(0.3, 1 if resonant else 3) * NOMINAL.b1,
            J_out=between(0.01, 10),
            control_frequency=between(slowest, 50),
        )
        point = OperatingPoint(between(500, 5000), float(rng.uniform(0, 40 if resonant else 70)))
        if resonant:
            speed = 60 * resonance(Drive([gear], [point]))[0] / rng.choice([1, 2, 4]) * between(0.9, 1.1)
            if not 500 <= speed <= 5000:
                continue
            point = replace(point, n_in_rpm=float(speed))
        cases.append((gear, point))
    return cases


def revolution(cases: list[Case]) -> Motion:
    return steady_revolution(Drive(*zip(*cases, strict=True)), np.zeros(len(cases)), POINTS)


def integrated(cases: list[Case], state: State, turns: int, averaged: int = 1) -> tuple[Lines, State]:
    """Order lines of T_out over the angle, as a mean of the last revolutions by solve_ivp; and the state at the end.

    Each revolution starts at the same position of the output, so that the friction over an output revolution (b3) does
    not change. All cases are integrated as one system, which takes hardly longer than a single one.
    """
    drive = Drive(*zip(*cases, strict=True))
    angles, torque = 2 * np.pi * np.arange(257) / 256, np.zeros((256, len(cases)))

    def rate(_: float, y: np.ndarray) -> np.ndarray:
        there = y.reshape(state.shape)
        return (drive.derivative(there, drive.torques(there)) / there[OMEGA_IN]).ravel()

    for turn in range(turns):
        found = solve_ivp(rate, (0, 2 * np.pi), state.ravel(), t_eval=angles, rtol=1e-6, atol=1e-8).y
        found = np.moveaxis(found.reshape(*state.shape, -1), -1, 1)
        if turn >= turns - averaged:
            torque += drive.torques(found[:, :-1]).T_out / averaged
        state = found[:, -1].copy()
        state[PHI_IN] -= 2 * np.pi
        state[PHI_OUT] -= 2 * np.pi / (drive.p["N"] + 1)
    return orders(torque.T), state


def orders(torque: np.ndarray) -> Lines:
    """Order lines 0 to 8 of a torque at even angles [N m]."""
    return 2 * np.fft.rfft(torque)[..., :9] / torque.shape[-1]


def lines(motion: Motion, row: int = 0) -> Lines:
    """Order lines of T_out over the angle."""
    over_angle = CubicSpline(motion.phi_in[row], motion.T_out[row], bc_type="periodic")
    return orders(over_angle(2 * np.pi * np.arange(256) / 256))


@pytest.mark.parametrize("case", LIFTING)
def test_where_teeth_lift_the_motion_is_that_of_solve_ivp(case: Case) -> None:
    found = stable_revolution(Drive([case[0]], [case[1]]), 0.0, 256)
    assert found is not None
    assert found.motion.T_out.min() < 0 < found.motion.T_out.max()
    (expected,), after = integrated([case], found.start, 1)
    np.testing.assert_allclose(lines(found.motion), expected, atol=2e-3 * np.abs(expected[1:]).max())
    np.testing.assert_allclose(after[OMEGA_IN], found.start[OMEGA_IN], rtol=1e-3)


@pytest.mark.slow
def test_from_uniform_rotation_solve_ivp_settles_at_the_motion_that_was_found() -> None:
    drive = Drive(*zip(*LIFTING, strict=True))
    found = steady_revolution(drive, np.zeros(len(LIFTING)), 256)
    for row, expected in enumerate(integrated(LIFTING, uniform_rotation(drive), 150)[0]):
        np.testing.assert_allclose(lines(found, row), expected, atol=5e-3 * np.abs(expected[1:]).max())


@pytest.fixture
def short_means(monkeypatch: pytest.MonkeyPatch) -> None:
    """A third of the revolutions tells as well whether a mean is right to some per cent, and that there is one."""
    monkeypatch.setattr(unsteady, "MOST_TURNS", 60)


@pytest.mark.slow
@pytest.mark.usefixtures("short_means")
def test_the_mean_revolution_of_a_hunting_gear_is_that_of_solve_ivp() -> None:
    """Its revolutions differ by a fifth of the ripple, so two means over many agree to some per cent of it. The state
    at its end is one that the motion goes on from.
    """
    drive = Drive([HUNTING[0]], [HUNTING[1]])
    assert stable_revolution(drive, 0.0, POINTS) is None
    found = mean_revolution(drive, np.zeros(1), POINTS)
    (expected,), _ = integrated([HUNTING], found.end, 60, averaged=60)
    np.testing.assert_allclose(lines(found.motion), expected, atol=0.05 * np.abs(expected[1:]).max())


def test_the_mean_of_a_motion_that_repeats_is_that_motion() -> None:
    points = [OperatingPoint(n, T) for n in (1500, 2000) for T in (7, 70)]
    drive, start = Drive([NOMINAL] * 4, points), np.array([0.0, 0.7, -0.4, 3.0])
    found, end = mean_revolution(drive, start, POINTS)
    expected = steady_revolution(drive, start, POINTS)
    for name in ("phi_in", "omega_in", "omega_out", "T_in", "T_out", "T_flange", "dt"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=2e-4, atol=2e-4)
    np.testing.assert_allclose(end[PHI_IN], start, atol=1e-9)


def test_newtons_method_finds_what_the_harmonic_balance_finds() -> None:
    drive = Drive([NOMINAL], [OperatingPoint(2000, 39)])
    found, expected = stable_revolution(drive, 0.7, LEAST_TIMES), steady_revolution(drive, np.array([0.7]), LEAST_TIMES)
    assert found is not None
    np.testing.assert_allclose(found.motion.T_out, expected.T_out, rtol=1e-6)
    np.testing.assert_allclose(found.start[PHI_IN], 0.7)


def test_a_run_that_is_hard_leaves_the_others_of_its_batch_as_they_are() -> None:
    easy = [(NOMINAL, OperatingPoint(n, 39)) for n in (1500, 3000)]
    mixed = Drive(*zip(easy[0], LIFTING[0], easy[1], strict=True))
    _, converged = shooting(mixed)
    assert converged.tolist() == [True, False, True]
    together, apart = steady_revolution(mixed, np.zeros(3), POINTS), revolution(easy)
    np.testing.assert_allclose(together.T_out[[0, 2]], apart.T_out, rtol=1e-6)
    hard = mixed.part([1])
    window = run(hard, steady_state(hard), hard.period[0] / POINTS, POINTS)
    np.testing.assert_allclose(window.T_out[0], together.T_out[1], atol=0.02 * np.ptp(window.T_out))


def test_no_gear_of_the_hard_corner_raises() -> None:
    """Without those that hunt, whose integration takes long."""
    found = revolution(drawn(generator("hard corner"), 30, resonant=True, slowest=3.0))
    assert np.isfinite(found.T_out).all()


@pytest.fixture
def each_mean_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same mean revolution is integrated once: a motion and a state from it are two questions."""
    known: dict[tuple[object, ...], Averaged] = {}

    def remembered(drive: Drive, start: np.ndarray, points: int) -> Averaged:
        key = (drive.transmissions, drive.points, start.tobytes(), points)
        if key not in known:
            known[key] = mean_revolution(drive, start, points)
        return known[key]

    monkeypatch.setattr(settling, "mean_revolution", remembered)


@pytest.mark.slow
@pytest.mark.usefixtures("each_mean_once", "short_means")
def test_no_gear_of_two_hundred_raises() -> None:
    """Half of them over the whole range, half close to a resonance."""
    rng = generator("two hundred gears")
    cases = [*drawn(rng, 100, resonant=False), *drawn(rng, 100, resonant=True)]
    drive = Drive(*zip(*cases, strict=True))
    found = steady_revolution(drive, np.zeros(len(cases)), LEAST_TIMES)  # at as many times as a state is searched
    speed, load = ([getattr(point, name) for _, point in cases] for name in ("n_in_rpm", "T_out"))
    np.testing.assert_allclose(found.omega_in[:, :-1].mean(axis=1) * 30 / np.pi, speed, rtol=0.01)
    np.testing.assert_allclose(found.T_out[:, :-1].mean(axis=1), load, rtol=0.05, atol=1.0)
    states = steady_state(drive)
    assert np.isfinite(states).all()


def test_a_speed_that_is_not_held_is_named_with_what_to_look_at(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unsteady, "SPEED_TOLERANCE", 0.0)
    drive = Drive([replace(NOMINAL, control_frequency=50.0)], [OperatingPoint(2000, 7)])
    with pytest.raises(NoSteadyState, match=r"2000 rpm and 7 N m turns at 2000 rpm .* 50 Hz .*look at the friction"):
        mean_revolution(drive, np.zeros(1), POINTS)
