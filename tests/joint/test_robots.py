"""The virtual robot joints obey physics: analytic limits, energy, and the textbook where nothing is hidden."""

import numpy as np
import pytest
from robots import KINDS, joint
from robots.plant import CYCLE, Drive, Plant, moved, stribeck
from scipy.special import ellipk

PLANT = Plant(motor=0.8, link=1.2, gravity=0.0, constant=10.0, coulomb=6.0, viscous=4.0)
DRIVE = Drive(resolution=1e-7, cut_off=100.0, bandwidth=12.0, gravity_known=1.0, limit=200.0)
OFF = DRIVE._replace(limit=0.0, gravity_known=0.0)


def steady(speed, seconds=6.0):
    """Constant speed from the start."""
    time = np.arange(0, seconds, CYCLE)
    return np.stack([speed * time, np.full_like(time, speed), np.zeros_like(time)])


def there(way=0.8, seconds=4.0, standing=1.0):
    """From rest to rest along a cosine."""
    time = np.arange(0, seconds, CYCLE)
    rate = np.pi / seconds
    demand = np.stack([1 - np.cos(rate * time), rate * np.sin(rate * time), rate**2 * np.cos(rate * time)]) * way / 2
    rest = np.zeros((3, round(standing / CYCLE)))
    return np.hstack([demand, rest + np.array([[way], [0], [0]])])


@pytest.mark.parametrize("width", [0.0, 2e-3])
@pytest.mark.parametrize("speed", [0.05, -1.0])
def test_the_current_at_steady_speed_is_that_of_coulomb_and_viscous_friction(speed, width):
    current = moved(PLANT._replace(width=width), DRIVE, steady(speed), 0.0)[3, -1000:]
    assert current.mean() == pytest.approx(np.sign(speed) * (6 + 4 * abs(speed)) / 10, rel=1e-3)


@pytest.mark.parametrize(("speed", "excess"), [(0.025, 0.8), (0.05, 0.5), (0.5, 1 / 101)])
def test_lugre_at_steady_speed_is_its_stribeck_curve(speed, excess):
    plant = PLANT._replace(bristle=3e4, stiction=9.0, stribeck=0.05)
    current = moved(plant, DRIVE, steady(speed), 0.0)[3, -1000:]
    assert stribeck(plant, speed) == pytest.approx(6 + 3 * excess)
    assert current.mean() == pytest.approx((stribeck(plant, speed) + 4 * speed) / 10, rel=5e-3)


@pytest.mark.parametrize("start", [0.1, 2.0])
def test_a_free_joint_without_friction_is_a_pendulum(start):
    plant = PLANT._replace(gravity=20.0, coulomb=0.0, viscous=0.0)
    # Gravity acts with the cosine of the angle to the horizontal: the joint hangs at -pi/2.
    angle = moved(plant, OFF, np.zeros((3, 12000)), start - np.pi / 2)[0] + start
    up = np.flatnonzero((angle[:-1] < 0) & (angle[1:] >= 0)) * CYCLE
    period = 4 * np.sqrt(2.0 / 20.0) * ellipk(np.sin(start / 2) ** 2)
    assert np.diff(up).mean() == pytest.approx(period, rel=2e-3)


def test_coulomb_friction_holds_a_load_below_it_and_no_other():
    held = moved(PLANT._replace(gravity=5.99), OFF, np.zeros((3, 2000)), 0.0)
    falls = moved(PLANT._replace(gravity=6.2), OFF, np.zeros((3, 2000)), 0.0)
    assert np.ptp(held[0]) == 0
    assert falls[0, -1] < -0.05


@pytest.mark.parametrize(
    "extra",
    [{}, {"load_friction": 0.05}, {"stiffness": 3e4}, {"stiffness": 3e4, "gap": 1e-3, "cubic": 3e9, "error": 3e-4}],
)
def test_work_of_the_motor_is_heat_of_friction_and_height(extra):
    plant = PLANT._replace(gravity=15.0, **extra)
    angle, speed, _, current, load, _ = moved(plant, DRIVE, there(), 0.5)
    work = (plant.constant * current * np.gradient(angle)).sum()
    level = plant.coulomb + plant.load_friction * np.abs(load)
    heat = ((level * np.abs(speed) + plant.viscous * speed**2) * CYCLE).sum()
    height = plant.gravity * (np.sin(angle[-1] + 0.5) - np.sin(0.5))
    assert work == pytest.approx(heat + height, rel=0.01)


def test_the_kinematic_error_is_a_lever_of_the_load_on_the_motor():
    plant = PLANT._replace(gravity=15.0, stiffness=3e4, error=2e-4, ratio=50.0)
    angle, _, _, current, _, _ = moved(plant, DRIVE, steady(0.01, 15.0), 0.0)[:, 2000:]
    waves = np.stack([np.cos(100 * angle), np.sin(100 * angle), angle**2, angle, np.ones_like(angle)], axis=1)
    size = np.hypot(*np.linalg.lstsq(waves, current, rcond=None)[0][:2])
    assert size == pytest.approx(15.0 * 2 * 50 * 2e-4 / 10, rel=0.05)


def test_the_kinematic_error_makes_its_ripple_twice_per_motor_revolution():
    plant = PLANT._replace(gravity=0.0, stiffness=3e4, error=2e-4, ratio=50.0, coulomb=0.0)
    angle, *_, load, _ = moved(plant, DRIVE, steady(0.3, 12.0), 0.0)[:, 4000:]
    waves = [abs(np.mean(load * np.exp(-1j * order * angle))) for order in (50, 99, 100, 101, 200)]
    assert np.argmax(waves) == 2


@pytest.mark.parametrize("kind", KINDS)
def test_same_seed_same_numbers(kind):
    one, same, other = joint(3, kind), joint(3, kind), joint(4, kind)
    assert one.truth == same.truth != other.truth
    assert 8 <= len(one.recordings) <= 12
    for a, b in zip(one.recordings, same.recordings, strict=True):
        assert all(np.array_equal(a.signals[name], b.signals[name]) for name in a.signals)


def test_the_log_of_a_healthy_joint_is_the_textbook_and_noise():
    validation = 0
    for seed in range(20):
        moving, _, truth = joint(seed)
        if truth.signal != "current" or truth.rigid_factor is None:
            continue
        validation += 1
        for each in moving:
            omega = each.signals["omega"]
            friction = truth.plant.coulomb * np.sign(omega) + truth.plant.viscous * omega
            torque = each.signals["T_rigid"] / truth.rigid_factor + friction
            left = each.signals["current"] - torque / truth.plant.constant
            fast = np.abs(omega) > 0.3 * np.abs(omega).max()
            assert np.std(left[fast]) == pytest.approx(truth.current_noise, rel=0.1)
    assert validation >= 3
