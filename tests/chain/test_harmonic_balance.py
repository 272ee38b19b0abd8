"""Harmonic balance finds the motion that integrating settles at."""

import numpy as np

from swgsim.chain import harmonic_balance, settling
from swgsim.chain.dynamics import Drive
from swgsim.chain.harmonic_balance import one_revolution
from swgsim.chain.motion import Motion, revolve
from swgsim.chain.settling import steady_state
from swgsim.chain.steady_state_cache import Driven, drive_of, forget, one_turn
from swgsim.effects.base import Effect, overrides
from swgsim.effects.library import LIBRARY
from swgsim.effects.quantity import quantities, size_of
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint, Transmission
from swgsim.studies.benchmark import harmonic_balance_vs_integrating

POINTS = 64
OPERATING = [OperatingPoint(n, T) for n in (800.0, 4000.0) for T in (7.0, 70.0)]


def strong(name: str) -> Effect:
    """An effect of half the largest size that it may have."""
    kind = LIBRARY[name]
    size, declared = size_of(kind), quantities(kind)
    order = {"order": 4} if "order" in declared else {}
    return kind(**{size: 0.5 * declared[size].high}, **order)


def acts_on_the_drive(effect: Effect) -> bool:
    return overrides(effect.at(OPERATING[0], Conditions()), "drive")


def drive(b3: float, *effects: Effect) -> Drive:
    """Of a gear at all operating points, with effects as they act there."""
    own = [tuple(effect.at(point, Conditions()) for effect in effects) for point in OPERATING]
    return Drive([Transmission(b3=b3, rotor_share=0.3)] * len(own), OPERATING, own)


def both(of: Drive) -> tuple[Motion, Motion]:
    """By harmonic balance, and by integrating with so many steps that their error is small."""
    found, settled = one_revolution(of, np.zeros(len(of)), POINTS)
    assert settled.all()
    return found, revolve(of, steady_state(of), POINTS)


KINDS = [name for name in LIBRARY if LIBRARY[name].place == "drive" and acts_on_the_drive(strong(name))]


def test_it_is_the_motion_that_integrating_settles_at(monkeypatch):
    """Without an effect, and with each on the drive; runs follow each other by kind, at all operating points."""
    monkeypatch.setattr("swgsim.chain.motion.STEPS_PER_REVOLUTION", 4 * POINTS)
    each = [drive(0.0, *([strong(kind)] if kind else [])) for kind in ("", *KINDS)]
    found, expected = both(Drive(*([x for one in each for x in part(one)] for part in (
        lambda d: d.transmissions, lambda d: d.points, lambda d: d.effects))))  # fmt: skip
    for name in ("phi_in", "omega_in", "omega_out", "T_in", "T_out", "dt"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=1e-6, atol=1e-6)
    changed = np.abs(found.T_in - np.tile(found.T_in[: len(OPERATING)], (len(each), 1))).max(axis=1)
    acting = changed.reshape(len(each), -1).max(axis=1) > 1e-4
    # A gap that the load keeps closed changes nothing here.
    assert [kind for kind, acts in zip(("", *KINDS), acting, strict=True) if not acts] == ["", "lost_motion"]


def test_the_benchmark_compares_the_same_motion():
    found = harmonic_balance_vs_integrating([Transmission(b3=0.0)], OPERATING, POINTS)
    assert found["max_relative_difference"] < 1e-5
    assert found["runs"] == len(OPERATING)


def test_all_power_that_is_not_lost_comes_out():
    without = Transmission(b0=0, b1=0, b2=0, b3=0, mu=0)
    found, _ = one_revolution(Drive([without] * 4, OPERATING), np.zeros(4), POINTS)
    np.testing.assert_allclose(found.efficiency, 1, atol=1e-5)


def test_friction_over_the_output_revolution_acts_as_where_the_output_stands():
    found, expected = both(drive(0.07))
    without, _ = one_revolution(drive(0.0), np.zeros(len(OPERATING)), POINTS)
    # It changes within by a tenth of what it is, and how that is seen depends on the numbers of points.
    np.testing.assert_allclose(found.T_in.mean(axis=1), expected.T_in.mean(axis=1), atol=1e-4)
    assert (np.abs(found.T_in - without.T_in).mean(axis=1) > 5e-4).all()


def test_it_begins_at_the_angle_that_is_asked_for():
    start = np.array([0.0, 0.7, -0.4, 3.0])
    found, _ = one_revolution(drive(0.0), start, POINTS)
    whole, _ = one_revolution(drive(0.0), np.zeros(4), POINTS)
    np.testing.assert_allclose(found.phi_in[:, 0], start, atol=1e-9)
    for T_out, angle, one, at in zip(found.T_out, found.phi_in, whole.T_out, whole.phi_in, strict=True):
        again = np.interp(angle, at, one, period=2 * np.pi)
        np.testing.assert_allclose(T_out, again, atol=0.02 * np.ptp(one))


def test_what_does_not_settle_is_integrated(monkeypatch):
    runs = [Driven(Transmission(b3=0.0), point, (), 0.0) for point in OPERATING]
    forget()
    found = one_turn(runs, POINTS)
    forget()
    monkeypatch.setattr(harmonic_balance, "MOST_CORRECTIONS", 1)
    integrated = []
    shoot = settling.shooting
    monkeypatch.setattr(settling, "shooting", lambda drive: integrated.extend(drive.points) or shoot(drive))
    again = one_turn(runs, POINTS)
    forget()
    assert integrated == OPERATING
    np.testing.assert_allclose(again.T_out, found.T_out, rtol=1e-4)
    of, start = drive_of(runs)
    np.testing.assert_array_equal(again.T_out, revolve(of, steady_state(of, start), POINTS).T_out)
