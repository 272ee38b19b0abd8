"""Run-in: the two losses give the paper's figures, and stiffness is that of the static torque-twist curve."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from swgsim.chain.chain import Run, simulate
from swgsim.effects import RunIn
from swgsim.effects.run_in import B1_LOSS, K1_LOSS
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear, OperatingPoint, Transmission
from swgsim.gear.stiffness import static_torque, torsional_stiffness

POINTS = [OperatingPoint(n, T) for n in (2000, 4000) for T in (7, 39, 70)]


def stiffness_after(hours):
    return torsional_stiffness(RunIn(hours).gear(Gear()).transmission) / torsional_stiffness(Transmission())


def mean_efficiency(*effects):
    return simulate([Run(Gear(), point, effects) for point in POINTS], Window(), sectors=40).efficiency


def test_new_gear_is_unchanged():
    assert RunIn(0.0).gear(Gear()) == Gear()


def test_stiffness_falls_by_a_fifth_in_ten_hours_and_stays():
    assert stiffness_after(10.0) == pytest.approx(0.8, abs=5e-4)
    assert stiffness_after(250.0) == pytest.approx(stiffness_after(10.0), abs=0.01)


def test_loss_of_k1_is_the_one_that_solves_for_a_fifth():
    def miss(loss):
        k1 = Transmission().k1 * (1 - loss * (1 - np.exp(-10 / 3)))
        return torsional_stiffness(replace(Transmission(), k1=k1)) / torsional_stiffness(Transmission()) - 0.8

    assert brentq(miss, 0.1, 0.4) == pytest.approx(K1_LOSS, abs=1e-4)


def test_efficiency_rises_by_a_tenth_in_250_hours():
    assert 0 < B1_LOSS < 1
    rise = mean_efficiency(RunIn(250.0)) / mean_efficiency() - 1
    assert rise.mean() == pytest.approx(0.1, abs=5e-4)
    assert (rise > 0).all()


def test_linear_gear_has_the_closed_form_stiffness():
    linear = Transmission(k2=0.0)
    assert torsional_stiffness(linear) == pytest.approx(linear.k1 / np.tan(linear.alpha_tooth) ** 2)


def test_twist_at_the_torque_is_the_inverse_of_the_curve():
    gear = Transmission()
    assert static_torque(gear, 70 / torsional_stiffness(gear, 70.0)) == pytest.approx(70)
    assert torsional_stiffness(gear, 70.0) > torsional_stiffness(gear, 7.0)


@pytest.mark.parametrize("hours", [-1.0, 1e5, float("nan")])
def test_operating_time_outside_its_limits_is_an_error(hours):
    with pytest.raises(ValueError, match=r"hours of run in is .* must be a finite number from 0 to 10000"):
        RunIn(hours)


def test_stiffness_needs_a_torque():
    with pytest.raises(ValueError, match="T_out of the stiffness measurement is 0"):
        torsional_stiffness(Transmission(), 0.0)
