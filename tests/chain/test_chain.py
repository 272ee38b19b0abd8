"""The chain as a whole: what each fault does to signals and efficiency, and what it leaves alone."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR, SECTORS, amplitude

from swgsim.chain.chain import Run, simulate, simulate_turns
from swgsim.chain.signal_path import AT_ONCE
from swgsim.effects import Effect, ReducedDamping, RootToothCrack, TipToothCrack, WarmGrease
from swgsim.effects.axial_thrust import AxialThrust
from swgsim.effects.clipping import Clipping
from swgsim.effects.signal_hysteresis import SignalHysteresis
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data.features import Layout, features
from swgsim.storage.labelled_signals import SENSORS

POINT = OperatingPoint(2000, 39)
WINDOW = Window()


def signals(*effects: Effect, point: OperatingPoint = POINT) -> np.ndarray:
    return simulate([Run(GEAR, point, effects)], WINDOW, SECTORS).signals[0]


def test_signals_are_sinusoids_of_order_two() -> None:
    s = signals()
    lines = np.abs(np.fft.rfft(s[1] - s[1].mean()))
    assert lines.argmax() == 2 * 2  # two revolutions in the window
    assert lines[4] > 5 * np.delete(lines, 4).max()


@pytest.mark.end_to_end
def test_root_crack_changes_all_amplitudes_and_tip_crack_less() -> None:
    healthy = signals()
    root, tip = signals(RootToothCrack(0.01, 0.5)), signals(TipToothCrack(1.0, 0.5))
    assert min(abs(amplitude(root[s]) / amplitude(healthy[s]) - 1) for s in range(5)) > 0.005
    assert np.abs(tip - healthy).max() < np.abs(root - healthy).max()


def test_warm_grease_mimics_reduced_damping() -> None:
    """12 to 20 K more take a third of b1: the same signals and efficiency as the fault."""
    warm = WarmGrease(np.log(1.5) / 0.025)
    assert 12 < warm.dT < 20
    result = simulate([Run(GEAR, POINT, (e,)) for e in (warm, ReducedDamping(2 / 3))], WINDOW, SECTORS)
    np.testing.assert_allclose(result.signals[0], result.signals[1], atol=1e-9)


@pytest.mark.end_to_end
def test_shared_work_changes_nothing() -> None:
    runs = [Run(GEAR, p, e) for p in (POINT, OperatingPoint(4000, 7)) for e in ((), (RootToothCrack(0.05, 1.0),))]
    together = simulate(runs, WINDOW, SECTORS)
    for i, one in enumerate(runs):
        alone = simulate([one], WINDOW, SECTORS)
        np.testing.assert_allclose(together.signals[i], alone.signals[0], rtol=0, atol=1e-7)
        assert together.efficiency[i] == pytest.approx(alone.efficiency[0], rel=1e-9)


@pytest.mark.end_to_end
def test_a_full_bridge_has_twice_the_signal_of_a_half_bridge() -> None:
    full = replace(GEAR, gauges=replace(GEAR.gauges, active_arms=(4, 4, 2, 2, 2)))
    half, whole = simulate([Run(gear, POINT) for gear in (GEAR, full)], WINDOW, SECTORS).signals[:, 1]
    np.testing.assert_allclose(whole, 2 * half, atol=1e-7)


def test_empty_grid_is_refused() -> None:
    with pytest.raises(ValueError, match="the grid is empty"):
        simulate([], WINDOW)


@pytest.mark.parametrize("effect", [Clipping(0.22), SignalHysteresis(0.05)])
def test_corners_have_their_order_lines_with_few_samples_too(effect: Effect) -> None:
    run, layout = Run(GEAR, OperatingPoint(2000, 70), (effect,)), Layout(("s0", "s1", "s2"))
    few, many = (features(*simulate_turns([run], 1, points, SECTORS), layout) for points in (64, 4096))
    sound = features(*simulate_turns([replace(run, effects=())], 1, 64, SECTORS), layout)
    assert np.abs(many - sound).max() > 1e-3
    # A recording tells a line to about 2e-5 mV/V.
    np.testing.assert_allclose(few, many, rtol=0, atol=2e-6)


@pytest.mark.parametrize("sharp", [False, True])
def test_where_the_flange_sits_is_no_matter_of_the_gauges(sharp: bool) -> None:
    """At the brake it shows no ripple; gauges, and what effects make of them, feel the gear's torque all the same."""
    effects = (AxialThrust(0.01), *([Clipping(0.2)] if sharp else []))
    gears = [replace(GEAR, transmission=replace(GEAR.transmission, load_share=share)) for share in (0.0, 1.0)]
    runs = [Run(gear, OperatingPoint(2000.0, 70.0), effects) for gear in gears]
    at_gear, at_brake = (each.channels for each in simulate_turns(runs, 1, 64, SECTORS))
    assert np.ptp(at_gear["T_out"]) > 0.1
    np.testing.assert_allclose(at_brake["T_out"], 70.0)
    for sensor in SENSORS:
        np.testing.assert_allclose(at_brake[sensor], at_gear[sensor], atol=1e-9)


def test_where_nothing_is_clipped_other_effects_act_as_without_a_limit() -> None:
    runs = [Run(GEAR, OperatingPoint(2000, 70), (AxialThrust(0.01), *limit)) for limit in ((), (Clipping(5.0),))]
    plain, dense = (each.channels for each in simulate_turns(runs, 1, 64, SECTORS))
    for name, values in plain.items():
        np.testing.assert_allclose(dense[name], values, rtol=0, atol=1e-9)


def test_many_runs_are_seen_as_each_of_them_alone() -> None:
    """More with corners than are filtered at once, among others without."""
    limits = [[Clipping(0.1 + 0.005 * i)] * (i % 3 > 0) for i in range(2 * AT_ONCE)]
    runs = [Run(GEAR, OperatingPoint(2000, 60 + i % 2), tuple(limit)) for i, limit in enumerate(limits)]
    assert sum(map(bool, limits)) > AT_ONCE
    together = simulate_turns(runs, 1, 64, SECTORS)
    for run, among in list(zip(runs, together, strict=True))[::9]:
        (alone,) = simulate_turns([run], 1, 64, SECTORS)
        for name, values in alone.channels.items():
            np.testing.assert_allclose(among.channels[name], values, rtol=0, atol=1e-12)
