"""Rows that the textbook itself leaves open: friction of a joint that stands, and a load that jumps."""

import numpy as np
import pytest
from joint_fixtures import COULOMB, VISCOUS

from swgsim.common.seeds import generator
from swgsim.joint.kinematics import displaced, jitter, least_doubt
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Fit, Table
from swgsim.joint.row_variance import weighted_by_variance
from swgsim.joint.textbook import Friction, RigidBody, fitted_textbook

RATE, NOISE, INERTIA, MOVE = 100.0, 0.03, 0.4, 100


def strokes(seed: object, held: float | None, lag: float = 0.0) -> Table:
    """Strokes with constant acceleration and pauses; at rest, friction of any size up to ``held`` times Coulomb's.
    None: friction is elastic, and grows with the speed from rest.

    The speed is late by a lag [s].
    """
    recordings = []
    for number in range(4):
        rng = generator("strokes", seed, number)
        size = np.repeat(rng.choice([-1, 1], 24) * rng.uniform(0.5, 4, 24), MOVE)
        place = np.arange(len(size)) % MOVE
        acceleration = size * np.select([place < 20, place < 40, place < 60], [1.0, 0.0, -1.0], 0.0)
        omega = np.cumsum(acceleration) / RATE
        still = place >= 60
        rest = still * np.repeat(rng.uniform(-1, 1, 24), MOVE) * (held or 0.0)
        sign = np.tanh(omega / 0.01) if held is None else np.sign(omega) * ~still + rest
        time = np.arange(len(size)) / RATE
        current = INERTIA * acceleration + COULOMB * sign + VISCOUS * omega
        signals = {
            "q": np.cumsum(omega) / RATE,
            "omega": np.interp(time - lag, time, omega) + 1e-3 * rng.normal(size=len(time)),
            "current": current + NOISE * rng.normal(size=len(time)),
        }  # fmt: skip
        recordings.append(JointRecording(f"run{number}", "robot", "joint", f"day{number % 2}", time, signals))
    return Table(tuple(recordings), "current")


def trust_at_rest(found: Fit) -> float:
    assert found.table.trust is not None
    return float(np.median(found.table.trust[np.tile(np.arange(MOVE) == 80, 96)]))


def test_a_standstill_counts_as_one_sample_with_the_variance_of_coulomb_friction() -> None:
    found = weighted_by_variance(fitted_textbook(strokes("open", 1.0)))
    once = NOISE / (COULOMB / np.sqrt(3))
    # The residual of the first fit has more than the noise, as what holds the joint disturbs it.
    assert once / np.sqrt(40) < trust_at_rest(found) < 2 * once / np.sqrt(40)


def test_a_joint_that_is_predicted_at_rest_is_trusted_there() -> None:
    assert trust_at_rest(weighted_by_variance(fitted_textbook(strokes("known", None)))) > 0.7


def test_what_holds_a_joint_does_not_change_the_friction_of_its_motion() -> None:
    found = weighted_by_variance(fitted_textbook(strokes("friction", 1.0, lag=0.01)))
    weights = {type(term): term for term in found.terms}
    coulomb, viscous = weights[Friction].weights
    assert (coulomb, viscous) == (pytest.approx(COULOMB, rel=0.03), pytest.approx(VISCOUS, rel=0.1))
    assert weights[RigidBody].weights[0] == pytest.approx(INERTIA, rel=0.05)


@pytest.mark.parametrize("noise", [1e-3, 2e-3, 4e-3])
def test_the_direction_at_rest_is_that_of_the_last_displacement_however_the_speed_scatters(noise: float) -> None:
    """Long strokes allow long windows, over which the smoothed speed of a short stroke swings back."""
    rng, place, short = generator("held", noise), np.arange(24 * 600) % 600, np.repeat(np.arange(24) % 8 == 0, 600)
    way, length = np.repeat(rng.choice([-1, 1], 24), 600), np.where(short, 75, 450)
    share = np.minimum(place / length, 1)
    omega = way * np.where(short, 0.6, 0.5) * 16 * (share * (1 - share)) ** 2
    q = np.cumsum(omega) / 500 + 5e-7 * rng.normal(size=len(omega))
    signals = {"q": q, "omega": omega + noise * rng.normal(size=len(omega)), "current": omega}
    held = JointRecording("run", "robot", "joint", "day", np.arange(len(q)) / 500, signals).held
    rest = place > length + 10
    assert (held[rest] == way[rest]).mean() > 0.99
    assert not (held[rest] == -way[rest]).any()


def test_noise_and_the_jitter_of_an_encoder_are_no_displacement() -> None:
    rng, step = generator("displaced"), 1e-4
    for still in (step * np.round(rng.uniform(0, 1, 20000)), step * rng.normal(size=20000)):
        least = float(np.median(jitter(still, 75)))
        assert not displaced(still, least).any()
        moved = np.concatenate([still, still[-1] - 40 * step * np.linspace(0, 1, 100)])
        assert displaced(moved, least)[-1] == -1


def test_a_slow_reversal_is_no_standstill() -> None:
    """Times that are uncertain by 1 ms make an angle uncertain where it moves fast."""
    rng, time = generator("reversals"), np.arange(6000) / RATE
    q = np.sin(0.5 * (time + 1e-3 * rng.normal(size=len(time))))
    signals = {"q": q, "omega": 0.5 * np.cos(0.5 * time) + 1e-4 * rng.normal(size=len(q)), "current": q}
    assert not JointRecording("run", "robot", "joint", "day", time, signals).held.any()


def test_the_acceleration_is_smoothed_no_longer_than_the_noise_asks_for() -> None:
    rng, time = generator("acceleration"), np.arange(2000) / RATE
    omega = np.sin(12 * time)
    for noise, most in ((1e-4, 0.05), (1e-2, 1.0)):
        found, doubt = least_doubt(omega + noise * rng.normal(size=len(time)), RATE, 1)
        error = float(np.sqrt(np.mean((found - 12 * np.cos(12 * time))[20:-20] ** 2)))
        assert error < most
        assert doubt == pytest.approx(error, rel=0.5)
