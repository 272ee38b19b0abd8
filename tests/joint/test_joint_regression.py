"""Weights of joint effects by least squares: what they recover, what they are blind to, and how sure they are."""

from dataclasses import replace

import numpy as np
import pytest
from joint_fixtures import TORQUE_NOISE, sessions, trajectories

from swgsim.common.seeds import generator
from swgsim.joint.effects.friction import AsymmetricFriction, QuadraticFriction
from swgsim.joint.effects.load import GravityError
from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import FOLDS, Fit, Table, fit, rms
from swgsim.joint.term import Term
from swgsim.joint.textbook import Friction, RigidBody, Zero, textbook

TERMS = (RigidBody(), Friction(), Zero())
TRUE = np.array([0.1, 0.4, 0.5, 0.03])


def stated(recording: JointRecording, terms: tuple[Term, ...], weights: np.ndarray, of: str) -> JointRecording:
    """A recording whose signal is exactly what terms predict."""
    columns = np.hstack([term.columns(recording) for term in terms])
    return replace(recording, signals={**recording.signals, of: columns @ weights})


def moved(recording: JointRecording, of: str, by: float) -> JointRecording:
    return replace(recording, signals={**recording.signals, of: recording.signals[of] + by})


RUNS = trajectories("regression", rate=20.0)
STEADY = sessions("regression", rate=100.0)


def test_weights_without_noise_are_exact_whatever_the_units() -> None:
    exact = tuple(stated(each, TERMS, TRUE, "current") for each in RUNS)
    found = fit(Table(exact, "current"), TERMS)
    np.testing.assert_allclose(found.weights, TRUE, rtol=1e-9)
    assert found.error < 1e-12
    large = tuple(stated(each, TERMS, 1e9 * TRUE, "current") for each in RUNS)
    np.testing.assert_allclose(fit(Table(large, "current"), TERMS).weights, 1e9 * TRUE, rtol=1e-9)
    assert [len(term.weights) for term in found.terms] == [1, 2, 1]


def test_weights_of_the_simulated_joints() -> None:
    current = fit(Table(RUNS, "current"), TERMS)
    assert (np.abs(current.weights - TRUE) < 2 * current.half_interval).all()
    torque = fit(Table(STEADY, "T_sensor"), textbook(STEADY, "T_sensor"))
    _, cosine, sine = torque.weights
    assert (cosine, sine) == pytest.approx((0.1, 0.05), abs=2e-3)
    assert torque.error == pytest.approx(TORQUE_NOISE, rel=0.1)


def test_a_torque_sensor_has_another_zero_in_every_run_and_a_current_one_zero() -> None:
    shifts = np.linspace(-3, 3, len(STEADY))
    terms = textbook(STEADY, "T_sensor")
    first = fit(Table(STEADY, "T_sensor"), terms)
    other = fit(Table(tuple(map(moved, STEADY, ["T_sensor"] * len(STEADY), shifts)), "T_sensor"), terms)
    np.testing.assert_allclose(other.weights, first.weights, atol=1e-9)
    np.testing.assert_allclose(other.unseen, first.unseen, atol=1e-9)
    assert np.abs(np.bincount(first.table.run, first.residual)).max() < 1e-9
    shifted = fit(Table(tuple(map(moved, RUNS, ["current"] * len(RUNS), (-3, -1, 1, 3))), "current"), TERMS)
    assert shifted.error > 1


def by_hand(found: Fit, group: np.ndarray) -> np.ndarray:
    left = np.full(len(group), np.nan)
    for each in np.unique(group):
        out = group == each
        left[out] = found.table.signal[out] - found.X[out] @ np.linalg.lstsq(found.X[~out], found.table.signal[~out])[0]
    return left


@pytest.mark.parametrize("of", ["current", "T_sensor"])
def test_unseen_is_the_error_of_refits_without_each_run(of: str) -> None:
    runs = RUNS if of == "current" else STEADY
    found = fit(Table(runs, of), (*textbook(runs, of), GravityError(), Ripple(order=8.0)))
    group = np.concatenate([np.full(len(each), number) for number, each in enumerate(runs)])
    np.testing.assert_allclose(found.unseen, by_hand(found, group), atol=1e-6)
    assert rms(found.unseen) > found.error


def test_a_single_run_is_cut_to_parts() -> None:
    found = fit(Table(RUNS[:1], "current"), (*TERMS, QuadraticFriction()))
    parts = np.repeat(np.arange(FOLDS), len(RUNS[0]) // FOLDS)
    np.testing.assert_allclose(found.unseen, by_hand(found, parts), atol=1e-8)


def test_error_on_other_runs_is_that_of_their_prediction() -> None:
    found = fit(Table(RUNS[:3], "current"), TERMS)
    other = Table(RUNS[3:], "current")
    expected = RUNS[3].signals["current"] - sum(term.signal(RUNS[3]) for term in found.terms)
    np.testing.assert_allclose(found.missed(other), expected)
    assert rms(found.missed(found.table)) == pytest.approx(found.error)


def test_intervals_cover_the_truth_where_noise_is_alike_within_a_stretch() -> None:
    """200 draws; half of the noise is one number for a second: intervals of white noise would be far too short."""
    exact = [stated(each, TERMS, TRUE, "current") for each in RUNS]
    covered, too_short = np.zeros(len(TRUE)), np.zeros(len(TRUE))
    draws = 200
    for draw in range(draws):
        rng = generator("coverage", draw)
        noisy = []
        for each in exact:
            noise = np.repeat(rng.normal(size=len(each) // 20), 20) + rng.normal(size=len(each))
            noisy.append(replace(each, signals={**each.signals, "current": each.signals["current"] + 0.02 * noise}))
        found = fit(Table(tuple(noisy), "current"), TERMS)
        covered += np.abs(found.weights - TRUE) < found.half_interval
        white = 1.96 * found.error * np.sqrt(np.diag(np.linalg.inv(found.X.T @ found.X)))
        too_short += np.abs(found.weights - TRUE) < white
    assert (covered / draws > 0.90).all()
    assert (covered / draws < 0.985).all()
    assert (too_short / draws < 0.80).all()


def test_columns_that_cannot_be_told_apart_share_their_weight() -> None:
    exact = tuple(stated(each, TERMS, TRUE, "current") for each in RUNS)
    once, twice = fit(Table(exact, "current"), TERMS), fit(Table(exact, "current"), (*TERMS, RigidBody(), Zero()))
    assert twice.weights[[0, 4]] == pytest.approx([0.05, 0.05], rel=1e-6)
    np.testing.assert_allclose(twice.X @ twice.weights, once.X @ once.weights, atol=1e-9)
    assert np.abs(twice.unseen).max() < 1e-6
    assert np.isfinite(twice.half_interval).all()


def test_columns_that_can_hardly_be_told_apart_do_not_explode() -> None:
    """One direction only: its sense and a zero are the same, and so are both halves of an asymmetric friction."""
    terms = (*textbook(STEADY, "current"), AsymmetricFriction())
    found = fit(Table(STEADY, "current"), terms)
    assert np.abs(found.weights).max() < 10
    assert rms(found.unseen) < 1.2 * found.error
    assert found.basis.shape[1] < found.X.shape[1]


def test_a_column_of_nothing_has_no_weight() -> None:
    level = trajectories("regression", rate=20.0, weight=0.0)
    without = tuple(replace(each, signals={**each.signals, "T_rigid": 0 * each.time}) for each in level)
    found = fit(Table(without, "current"), TERMS)
    assert found.weights[0] == 0
    assert np.isfinite(found.unseen).all()
    assert np.isfinite(found.half_interval).all()


def test_a_signal_that_is_lacking_is_named() -> None:
    with pytest.raises(ValueError, match="recording run 0 has no signal T_sensor"):
        Table(RUNS, "T_sensor")
    with pytest.raises(ValueError, match="no recording has the signal current"):
        Table((), "current")


def test_stretches_are_seconds_of_a_run() -> None:
    table = Table(RUNS[:2], "current")
    assert np.bincount(table.stretch).tolist() == [20] * 50
    assert np.bincount(Table(STEADY[:3], "current").session).tolist() == [3 * len(STEADY[0])]
