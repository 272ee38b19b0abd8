"""Motions that are remembered are those that would be computed."""

import numpy as np
import pytest

from swgsim.chain import steady_state_cache as turning
from swgsim.chain.steady_state_cache import Driven, forget, one_turn
from swgsim.effects.library import LIBRARY
from swgsim.gear.gear import OperatingPoint, Transmission

SOFT = Driven(Transmission(k1=4000.0), OperatingPoint(2000.0, 39.0), (), 0.0)
STIFF = Driven(Transmission(k1=5000.0), OperatingPoint(4000.0, 70.0), (), 0.3)
HUMMING = SOFT._replace(effects=(LIBRARY["motor_torque_ripple"](order=6, amplitude=0.01),))
CHANNELS = ("phi_in", "omega_in", "omega_out", "T_in", "T_out", "dt")


@pytest.fixture(autouse=True)
def _afresh():
    forget()
    yield
    forget()


def test_what_is_remembered_is_what_would_be_computed():
    fresh = one_turn([SOFT, STIFF, HUMMING], 64)
    again = one_turn([HUMMING, SOFT], 64)
    for name in CHANNELS:
        np.testing.assert_array_equal(getattr(again, name), getattr(fresh, name)[[2, 0]])
    assert not np.allclose(fresh.T_in[0], fresh.T_in[2])


def test_only_what_is_new_is_computed(monkeypatch):
    one_turn([SOFT], 64)
    computed = []
    drive = turning.drive_of
    monkeypatch.setattr(turning, "drive_of", lambda driven: computed.extend(driven) or drive(driven))
    one_turn([SOFT, STIFF], 64)
    one_turn([STIFF, SOFT], 64)
    one_turn([SOFT], 32)
    assert computed == [STIFF, SOFT]


def test_batches_agree_to_the_accuracy_of_the_steady_state():
    together = one_turn([SOFT, STIFF], 64)
    forget()
    for number, each in enumerate((SOFT, STIFF)):
        alone = one_turn([each], 64)
        for name in CHANNELS:
            np.testing.assert_allclose(getattr(alone, name)[0], getattr(together, name)[number], rtol=1e-6, atol=1e-7)


def test_a_revolution_is_repeated():
    one = one_turn([SOFT, STIFF], 64)
    found = one.repeated(3)
    for name in CHANNELS[1:-1]:
        np.testing.assert_array_equal(getattr(found, name)[:, :-1], np.tile(getattr(one, name)[:, :-1], 3))
    np.testing.assert_array_equal(found.phi_in[:, :64], one.phi_in[:, :64])
    np.testing.assert_allclose(np.diff(found.phi_in)[:, 64:], np.diff(found.phi_in)[:, :-64], atol=1e-9)
    np.testing.assert_allclose(found.phi_in[:, -1] - found.phi_in[:, 0], 6 * np.pi, atol=1e-9)
    np.testing.assert_allclose(found.efficiency, one.efficiency, rtol=1e-9)


def test_memory_is_bounded(monkeypatch):
    monkeypatch.setattr(turning, "MOST_MOTIONS", 2)
    one_turn([SOFT, STIFF], 64)
    found = one_turn([STIFF, HUMMING], 64)
    assert len(turning._remembered) == len(found.phi_in) == 2
