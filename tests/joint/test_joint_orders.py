"""Orders that stand out of a residual, on analytic signals."""

import numpy as np
import pytest
from joint_fixtures import coloured
from scipy.stats import binom

from swgsim.common.seeds import generator
from swgsim.joint.orders import lines, spectrum
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Table

RATE = 500.0
LEVEL = 0.05


def steady(speeds: tuple[float, ...], rate: float = RATE, ratio: float | None = None) -> Table:
    runs = []
    for number, speed in enumerate(speeds):
        time = np.arange(int(4 * rate)) / rate
        signals = {"q": number + speed * time, "omega": np.full(len(time), speed), "current": 0 * time}
        runs.append(JointRecording(f"run {number}", "robot", "joint", "day", time, signals, gear_ratio=ratio))
    return Table(tuple(runs), "current")


def swinging(ratio: float | None = None) -> Table:
    time = np.arange(25 * 100) / 100
    runs = []
    for number in range(3):
        w = 2 * np.pi * (0.08 + 0.02 * number)
        signals = {"q": 2 * np.sin(w * time), "omega": 2 * w * np.cos(w * time), "current": 0 * time}
        runs.append(JointRecording(f"run {number}", "robot", "joint", "day", time, signals, gear_ratio=ratio))
    return Table(tuple(runs), "current")


def angle(table: Table) -> np.ndarray:
    return np.concatenate([each.signals["q"] for each in table.recordings])


def speed(table: Table) -> np.ndarray:
    return np.concatenate([each.signals["omega"] for each in table.recordings])


SPEEDS = (0.1, 0.3, 0.5, 0.7, 1.0)
RESOLUTION = 2 * np.pi / 4  # the longest run turns 4 rad
FIVE = steady(SPEEDS)
SWINGING = swinging()


@pytest.mark.parametrize("order", [37.3, 202.0, 700.0])
@pytest.mark.parametrize("size", [0.3, 30.0])
def test_a_wave_is_found_at_its_order(order: float, size: float) -> None:
    """Weaker than the noise, and so strong that its chance is below the smallest number of the machine."""
    noise = generator("orders", order).normal(size=len(FIVE.run))
    found = lines(FIVE, size * np.cos(order * angle(FIVE) + FIVE.run) + noise, 0.005, 4, above=1)
    assert found[0].order == pytest.approx(order, abs=RESOLUTION / 2)
    assert found[0].log_chance < np.log(0.005)
    # Further ones are at most the skirts of that line in the shortest run; those of a strong one reach further.
    assert size > 1 or all(abs(line.order - order) < 2 * np.pi / (4 * SPEEDS[0]) for line in found)


def test_two_waves_are_found_the_least_likely_first_and_above_a_bound() -> None:
    wave = 0.3 * np.cos(202 * angle(FIVE)) + 0.6 * np.sin(700 * angle(FIVE)) + 0.6 * np.cos(37.3 * angle(FIVE))
    wave += generator("two").normal(size=len(wave))
    found = lines(FIVE, wave, 0.005, 4, above=100)
    assert found[0].order == pytest.approx(700, abs=RESOLUTION / 2)
    assert any(abs(line.order - 202) < RESOLUTION / 2 for line in found)
    assert [line.log_chance for line in found] == sorted(line.log_chance for line in found)
    assert all(line.order > 100 for line in found)
    assert len(lines(FIVE, wave, 0.005, 1, above=100)) == 1
    assert any(abs(line.order - 37.3) < RESOLUTION / 2 for line in lines(FIVE, wave, 0.005, 4, above=30))


@pytest.mark.parametrize("table", ["steady", "swinging"])
@pytest.mark.parametrize("colour", ["white", "coloured"])
def test_false_alarms_are_as_rare_as_is_said(table: str, colour: str) -> None:
    used = steady(SPEEDS[2:], rate=200.0, ratio=20.0) if table == "steady" else swinging(ratio=20.0)
    draws, alarms = 60, 0
    for draw in range(draws):
        rng = generator("false alarms", table, colour, draw)
        parts = [
            rng.normal(size=len(each)) if colour == "white" else coloured(rng, len(each), each.rate, 1.0)
            for each in used.recordings
        ]
        alarms += bool(lines(used, np.concatenate(parts), LEVEL, 4, above=10))
    assert alarms <= binom.ppf(0.999, draws, LEVEL)


@pytest.mark.parametrize("law", ["same", "sign"])
def test_a_wave_is_found_in_a_swing_whether_it_turns_its_sign_or_not(law: str) -> None:
    by = np.sign(speed(SWINGING)) if law == "sign" else 1.0
    signal = 0.3 * by * np.cos(202 * angle(SWINGING)) + generator("swing", law).normal(size=len(SWINGING.run))
    found = lines(SWINGING, signal, 0.005, 4, above=40)
    assert found[0].order == pytest.approx(202, abs=2 * np.pi / 4 / 2)
    orders, power = spectrum(SWINGING, signal, 400)
    here = np.abs(orders - 202).argmin()
    same, turned = np.nansum(power[0::2, here]), np.nansum(power[1::2, here])
    assert (turned > 3 * same) if law == "sign" else (same > 3 * turned)


def test_noise_has_a_power_of_two_at_every_order() -> None:
    _, power = spectrum(FIVE, generator("power").normal(size=len(FIVE.run)), 2500)
    usual = np.nanmean(power[0::2, 100:], axis=1)
    np.testing.assert_allclose(usual, 2, rtol=0.3)
    assert np.isnan(power[1::2]).all()  # one direction only


def test_nothing_is_said_of_orders_that_a_run_cannot_show() -> None:
    orders, power = spectrum(FIVE, generator("unseen").normal(size=len(FIVE.run)), 2500)
    for number, each in enumerate(SPEEDS):
        visible = np.isfinite(power[2 * number])
        assert orders[visible].min() >= 2 * 2 * np.pi / (each * 4) * 0.99
        assert orders[visible].max() * each / (2 * np.pi) < RATE / 2


def test_a_wave_too_fast_for_the_sampling_is_not_taken_for_another_one() -> None:
    """Order 700 at 1 rad/s is 111 Hz, beyond half of 100 Hz: at order 72 it would look like 11 Hz."""
    one = steady((1.0,), rate=100.0)
    orders, power = spectrum(one, np.cos(700 * angle(one)) + generator("alias").normal(size=len(one.run)), 2500)
    assert np.isnan(power[0, orders > 315]).all()
    assert np.isfinite(power[0, orders < 240][10:]).all()


def test_gear_ratio_says_how_high_to_look() -> None:
    table = steady((0.2, 0.3), ratio=10.0)
    wave = np.cos(300 * angle(table)) + 0.1 * generator("ratio").normal(size=len(table.run))
    assert all(line.order <= 250 for line in lines(table, wave, 0.005, 4, above=1))
    unbounded = steady((0.2, 0.3))
    assert lines(unbounded, wave, 0.005, 1, above=1)[0].order == pytest.approx(300, abs=2 * np.pi / 1.2)
