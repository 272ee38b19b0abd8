"""Effects of wave generator, mesh and structure: orders, pattern over gauges, laws in load, speed and temperature."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
import pytest
from chain_fixtures import GEAR, SECTORS, map_of

import swgsim.effects as fx
from swgsim.chain.chain import Run, simulate_turns
from swgsim.effects.base import Effect
from swgsim.effects.frozen import turned
from swgsim.effects.quantity import quantities, size_of
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

REVOLUTIONS = 12
EFFECTS: Mapping[str, Effect] = {
    "rotating eccentricity": fx.RotatingEccentricity(20e-6, 0.3),
    "rotating eccentricity, equal lobes": fx.RotatingEccentricity(20e-6, 0.3, unequal=0),
    "fixed eccentricity": fx.EccentricWaveGenerator(2e-6, 0.3),
    "fixed eccentricity, further around": fx.EccentricWaveGenerator(4e-6, 1.0),
    "fixed eccentricity, equal lobes": fx.EccentricWaveGenerator(2e-6, 0.3, unequal=0),
    "fixed eccentricity, stiff teeth": fx.EccentricWaveGenerator(2e-6, 0.3, unequal=3),
    "tilt": fx.TiltedWaveGenerator(1e-3, 0.3),
    "tilt about the middle": fx.TiltedWaveGenerator(1e-3, 0.3, lever=0.0),
    "coning": fx.Coning(0.1),
    "lobe shift": fx.LobeShift(0.05),
    "load sharing": fx.LoadSharing(0.5),
    "teeth 3": fx.UnevenTeeth(3, 0.1, 0.4),
    "teeth 4": fx.UnevenTeeth(4, 0.1, 0.4),
    "runout 1": fx.CircularSplineRunout(1, 0.05, 0.4),
    "runout 2": fx.CircularSplineRunout(2, 0.05, 0.4),
    "sleeve 1": fx.UnevenSleeve(1, 0.02, 0.4),
    "sleeve 2": fx.UnevenSleeve(2, 0.02, 0.4),
    "out of round 2": fx.OutOfRound(2, 10e-6, 0.4),
    "out of round 3": fx.OutOfRound(3, 10e-6, 0.4),
    "out of round 4": fx.OutOfRound(4, 10e-6, 0.4),
    "thermal growth": fx.ThermalGrowth(1.2e-3),
    "wear": fx.WornWaveGenerator(0.02),
    "speed": fx.SpeedDeformation(0.01),
    "mesh shift": fx.MeshShift(0.05),
    "cam form 3": fx.CamForm(3, 2e-6, 0.3),
    "cam form 3, later": fx.CamForm(3, 4e-6, 1.0),
    "cam form 4": fx.CamForm(4, 2e-6, 0.3),
    "cam form 5": fx.CamForm(5, 2e-6, 0.3),
    "root crack": fx.RootToothCrack(0.1, 0.5),
    "root crack, a quarter further": fx.RootToothCrack(0.1, 0.5 + np.pi / 2),
    "tip crack": fx.TipToothCrack(1.0, 0.5),
    "tip crack, a quarter further": fx.TipToothCrack(1.0, 0.5 + np.pi / 2),
    "tip crack, not taken over": fx.TipToothCrack(1.0, 0.5, taken_over=0),
    "cage": fx.BearingCage(1e-3, phase=0.7),
    "ball pass": fx.BallPass(1e-3, order=10.3, waves=3, phase=0.7),
    "breathing": fx.BallPass(1e-3, order=10.3, waves=0, phase=0.7),
}


class Setting(NamedTuple):
    """Speed [rpm], load [N m] and temperature [degC]."""

    n_in_rpm: float = 2000.0
    T_out: float = 7.0
    temperature: float = 25.0


BASE, LOADED, FAST, WARM = Setting(), Setting(T_out=70.0), Setting(n_in_rpm=4000.0), Setting(temperature=35.0)
Change = Callable[[str, Setting], np.ndarray]


@pytest.fixture(scope="module")
def recordings() -> dict[tuple[object, Setting], Recording]:
    """A recording of every effect in every setting, and of those with nothing of the effect in the warm one."""
    wanted: dict[tuple[object, Setting], tuple[Effect, ...]] = {
        (name, setting): (effect,) for name, effect in EFFECTS.items() for setting in (BASE, LOADED, FAST, WARM)
    }
    wanted |= {("healthy", setting): () for setting in (BASE, LOADED, FAST, WARM)}
    runs = [
        Run(GEAR, OperatingPoint(s.n_in_rpm, s.T_out), effects, conditions=Conditions(s.temperature))
        for (_, s), effects in wanted.items()
    ]
    return dict(zip(wanted, simulate_turns(runs, REVOLUTIONS, 64, SECTORS), strict=True))


def lines_of(recording: Recording) -> np.ndarray:
    """Orders 0 to 8 of s0 to s4, complex [uV/V]."""
    signals = np.array([recording.channels[sensor] for sensor in SENSORS])
    spectrum = 1e3 * np.fft.rfft(signals, axis=1)[:, ::REVOLUTIONS] / signals.shape[1]
    return spectrum[:, :9] * np.where(np.arange(9) == 0, 1, 2)


@pytest.fixture(scope="module")
def change(recordings: dict[tuple[object, Setting], Recording]) -> Change:
    """What an effect adds to the lines of s0 to s4."""
    return lambda name, setting: lines_of(recordings[name, setting]) - lines_of(recordings["healthy", setting])


def opposite(lines: np.ndarray) -> np.ndarray:
    """The part of s1 and s2 that is opposite in s3 and s4."""
    return 0.5 * (lines[1:3] - lines[3:5])


def alike(lines: np.ndarray) -> np.ndarray:
    """The part of s1 and s2 that is alike in s3 and s4."""
    return 0.5 * (lines[1:3] + lines[3:5])


# (order, factor from 7 to 70 N m, factor from 2000 to 4000 rpm): effects whose line of the order follows this law.
LAWS = {
    (1, 1, 1): ("rotating eccentricity",),
    (0, 1, 1): ("fixed eccentricity", "tilt", "out of round 2", "out of round 3", "out of round 4"),
    (2, 1, 1): ("tilt", "sleeve 1", "sleeve 2", "wear"),
    (3, 1, 1): ("cam form 3",),
    (4, 1, 1): ("cam form 4",),
    (5, 1, 1): ("cam form 5",),
    (0, 10, 1): ("tip crack", "root crack", "tip crack, not taken over", "teeth 4", "runout 1"),
    (2, 10, 1): ("fixed eccentricity", "tip crack", "coning", "lobe shift", "teeth 3", "mesh shift"),
    (4, 10, 1): ("tip crack", "runout 2"),
    (2, 90, 1): ("load sharing",),
    (2, 1, 4): ("speed",),
}


@pytest.mark.parametrize(
    ("name", "order", "load", "speed"), [(name, *law) for law, names in LAWS.items() for name in names]
)
def test_law_in_load_and_speed(change: Change, name: str, order: int, load: float, speed: float) -> None:
    """From 7 to 70 N m and from 2000 to 4000 rpm; torque ripple spoils the proportion a little."""
    base, loaded, fast = (np.linalg.norm(change(name, setting)[1:, order]) for setting in (BASE, LOADED, FAST))
    assert loaded / base == pytest.approx(load, rel=0.12)
    assert fast / base == pytest.approx(speed, rel=0.12)


def test_thermal_growth_knows_temperature_alone(change: Change) -> None:
    for setting in (BASE, LOADED, FAST):
        np.testing.assert_array_equal(change("thermal growth", setting), 0)
    assert np.abs(change("thermal growth", WARM)[1:, 2]).min() > 1


@pytest.mark.parametrize("name", [name for name in EFFECTS if name != "thermal growth"])
def test_only_thermal_growth_knows_the_temperature(change: Change, name: str) -> None:
    np.testing.assert_allclose(change(name, WARM), change(name, BASE), rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    "name",
    [
        *("rotating eccentricity", "fixed eccentricity", "tilt", "tilt about the middle", "teeth 3", "runout 1"),
        *("sleeve 1", "out of round 3", "cam form 3", "cam form 5"),
    ],
)
def test_odd_patterns_are_opposite_in_opposite_gauges(change: Change, name: str) -> None:
    lines = change(name, LOADED)
    assert np.linalg.norm(alike(lines)) < 0.003 * np.linalg.norm(opposite(lines))
    assert np.linalg.norm(lines[0]) < 0.002 * np.linalg.norm(lines[1:])


@pytest.mark.parametrize(
    "name",
    [
        *("coning", "lobe shift", "load sharing", "teeth 4", "runout 2", "sleeve 2", "wear", "speed", "mesh shift"),
        *("out of round 2", "out of round 4", "cam form 4"),
    ],
)
def test_even_patterns_are_alike_in_opposite_gauges(change: Change, name: str) -> None:
    lines = change(name, LOADED)
    assert np.linalg.norm(opposite(lines)) < 1e-6 * np.linalg.norm(alike(lines))


def test_rotating_eccentricity_goes_around_at_order_one(change: Change) -> None:
    lines = change("rotating eccentricity", BASE)
    np.testing.assert_allclose(lines[2:, 1] / lines[1:4, 1], -1j, atol=0.01)
    assert np.abs(np.delete(lines[1:], 1, axis=1)).max() < 0.005 * np.abs(lines[1:, 1]).min()
    assert np.abs(change("rotating eccentricity", LOADED)[1:, 3]).min() > 4 * np.abs(lines[1:, 3]).max()


def test_rotating_eccentricity_of_equal_lobes_is_the_same_at_all_loads(change: Change) -> None:
    """And without load it is that of unequal ones."""
    name = "rotating eccentricity, equal lobes"
    lines, loaded = change(name, BASE), change(name, LOADED)
    assert np.abs(loaded - lines).max() < 0.005 * np.abs(lines).max()
    unequal = change("rotating eccentricity", BASE)
    assert np.abs(change("rotating eccentricity", LOADED) - lines).max() > 0.01 * np.abs(lines).max()
    np.testing.assert_allclose(lines[1:, 1], unequal[1:, 1], rtol=0.02)


def test_stiff_teeth_load_the_lobes_of_a_fixed_eccentricity_three_times_as_unequally(change: Change) -> None:
    """Which is all that there is of it beside an offset of each gauge."""
    equal, paper, stiff = (
        change(f"fixed eccentricity{teeth}", LOADED)[1:] for teeth in (", equal lobes", "", ", stiff teeth")
    )
    assert np.abs(equal[:, 1:]).max() < 1e-6 * np.abs(paper[:, 1:]).max()
    np.testing.assert_allclose(stiff - equal, 3 * (paper - equal), atol=0.02 * np.abs(stiff - equal).max())


def test_a_fixed_eccentricity_offsets_the_gauges_by_one_wave_around_the_collar(change: Change) -> None:
    """Which turns with its direction and grows with it, under every load: here by 0.7 rad and to twice the size."""

    def offset(name: str, setting: Setting) -> complex:
        _, s1, s2, s3, s4 = change(name, setting)[:, 0].real
        return complex(s1 - s3, s2 - s4)

    for setting in (BASE, LOADED, FAST):
        further = offset("fixed eccentricity, further around", setting) / offset("fixed eccentricity", setting)
        assert further == pytest.approx(2 * np.exp(0.7j), rel=0.01)


@pytest.mark.parametrize(
    "name",
    [
        *("tilt", "teeth 3", "runout 1", "sleeve 1", "sleeve 2", "out of round 3"),
        *("fixed eccentricity", "root crack", "tip crack", "tip crack, not taken over"),
    ],
)
def test_what_is_fixed_to_the_flex_spline_makes_no_odd_orders(change: Change, name: str) -> None:
    """But for the order 1 of the torque ripple, which their offset per load passes on."""
    lines = np.abs(change(name, LOADED)[1:]).max(axis=0)
    assert lines[1::2].max() < 0.05 * lines[::2].max()


@pytest.mark.parametrize("n", [3, 4, 5])
def test_cam_form_travels_over_the_gauges_at_its_order(change: Change, n: int) -> None:
    """A wave cos n (theta - psi) comes to each gauge a quarter turn later; the grids of the torque bridge, half-way
    between them, are all in phase for four waves alone, as twice as many arms.
    """
    lines = change(f"cam form {n}", BASE)
    np.testing.assert_allclose(lines[2:, n] / lines[1:4, n], np.exp(-0.5j * np.pi * n), atol=0.005)
    assert lines[0, n] / lines[1, n] == pytest.approx(-2 if n == 4 else 0, abs=0.005)
    assert np.abs(np.delete(lines, n, axis=1)).max() < 0.02 * np.abs(lines[1:, n]).min()


def test_cam_form_has_its_amplitude_and_phase(change: Change) -> None:
    larger, smaller = (change(f"cam form 3{later}", BASE)[1:, 3] for later in (", later", ""))
    np.testing.assert_allclose(larger / smaller, 2 * np.exp(-0.7j), atol=0.005)


@pytest.mark.parametrize("name", ["root crack", "tip crack"])
def test_a_crack_a_quarter_further_gives_each_gauge_what_the_one_before_had(change: Change, name: str) -> None:
    """A quarter turn of the wave generator later, up to the torque ripple, which stays where it was."""
    here, further = change(name, LOADED), change(f"{name}, a quarter further", LOADED)
    expected = here[[0, 4, 1, 2, 3]] * np.exp(-0.5j * np.pi * np.arange(9))
    np.testing.assert_allclose(further, expected, atol=0.05 * np.abs(here).max())


def test_a_root_crack_opens_with_the_ellipse(change: Change) -> None:
    """So at order 2 and hardly more under load, which alone moves the means."""
    base, loaded = np.abs(change("root crack", BASE)), np.abs(change("root crack", LOADED))
    np.testing.assert_allclose(np.linalg.norm(loaded[:, 2]), np.linalg.norm(base[:, 2]), rtol=0.25)
    assert base[:, 2].max() > 30 * np.delete(base, 2, axis=1).max()


def test_a_root_crack_changes_amplitude_and_phase_of_the_grids_next_to_it(
    recordings: dict[tuple[object, Setting], Recording],
) -> None:
    """It is between s1 and s2, near a pair of grids of the torque bridge."""
    for setting in (BASE, LOADED):
        cracked, healthy = (lines_of(recordings[name, setting])[:, 2] for name in ("root crack", "healthy"))
        near, far = np.split(np.abs(cracked - healthy), [3])
        assert near.min() > 4 * far.max()
        ratio = (cracked / healthy)[:3]
        assert (np.abs(ratio) > 1.02).all()
        assert (np.abs(np.angle(ratio)) > 0.005).all()


@pytest.mark.parametrize(("name", "taken_over"), [("tip crack", True), ("tip crack, not taken over", False)])
def test_a_tip_crack_shows_while_a_lobe_is_within_45_degrees_of_it(
    recordings: dict[tuple[object, Setting], Recording], name: str, taken_over: bool
) -> None:
    """Teeth further away from the lobes are not engaged. What nobody takes over is missing in all gauges: on average
    the share of the circumference that four of 200 teeth make, as the torque bridge sees it.
    """
    faulty, healthy = (recordings[each, LOADED].channels for each in (name, "healthy"))
    added = np.array([faulty[sensor] - healthy[sensor] for sensor in SENSORS])
    from_lobe = np.abs((healthy["phi_in"] - 0.5 + np.pi / 2) % np.pi - np.pi / 2)
    engaged = from_lobe < np.pi / 4 + 4 * np.pi / 200
    assert np.abs(added[:, ~engaged]).max() < 1e-3 * np.abs(added[:, engaged]).max()
    if taken_over:
        assert np.abs(added[0]).max() < 0.1 * np.abs(added[1:]).max()
    else:
        assert added.max() < 0.02 * np.abs(added).max()
        assert added[0].mean() / healthy["s0"].mean() == pytest.approx(-4 / 200, rel=0.02)


def test_a_tip_crack_shows_several_times_as_much_if_nobody_takes_its_force_over(change: Change) -> None:
    taken, lost = (np.abs(change(name, LOADED)) for name in ("tip crack", "tip crack, not taken over"))
    assert np.linalg.norm(lost[1:]) > 3 * np.linalg.norm(taken[1:])
    assert lost[0].max() > lost[1:].max()


def test_tilt_is_an_eccentricity_and_an_uneven_order_two(change: Change) -> None:
    """The lever makes the offsets, the touching ends make order 2; without a lever it resembles an uneven sleeve."""
    tilt, middle, sleeve = (opposite(change(name, BASE)) for name in ("tilt", "tilt about the middle", "sleeve 1"))
    assert np.linalg.norm(tilt[:, 0]) > 3 * np.linalg.norm(tilt[:, 2]) > 10
    assert np.linalg.norm(middle[:, 0]) < 0.01 * np.linalg.norm(middle[:, 2])
    np.testing.assert_allclose(tilt[:, 2], middle[:, 2], atol=0.06 * np.linalg.norm(middle[:, 2]))
    likeness = np.abs(np.vdot(middle[:, 2], sleeve[:, 2])) / np.linalg.norm(middle[:, 2]) / np.linalg.norm(sleeve[:, 2])
    assert likeness > 0.99


def test_scaled_deflections_change_order_two_alone(change: Change) -> None:
    for name, setting in (("coning", BASE), ("wear", BASE), ("speed", FAST), ("thermal growth", WARM)):
        lines = np.abs(change(name, setting)[1:])
        assert np.delete(lines, 2, axis=1).max() < 0.01 * lines[:, 2].min()
    ratio = change("thermal growth", WARM)[1, 2] / change("wear", BASE)[1, 2]
    assert ratio == pytest.approx(-1.2e-3 * 10 / 0.02, rel=1e-6)


def test_shifted_lobes_and_mesh_change_phases(change: Change) -> None:
    """Turned by an angle, order k of the map turns by k times the angle."""
    healthy, lobes, mesh = (
        map_of(*(effect.at(OperatingPoint(2000, 70), Conditions()) for effect in effects)).coefficients
        for effects in ((), (fx.LobeShift(0.05),), (fx.MeshShift(0.05),))
    )
    for order in (2, 4):
        turn = np.exp(1j * order * 0.05)
        scale = np.abs(healthy[:, 1:, order]).max(axis=1, keepdims=True)
        np.testing.assert_allclose(lobes[:, 1:, order] / scale, turn * healthy[:, 1:, order] / scale, atol=0.002)
        np.testing.assert_allclose(mesh[1, 1:, order] / scale[1], turn * healthy[1, 1:, order] / scale[1], atol=0.002)
    np.testing.assert_array_equal(mesh[0], healthy[0])
    lines = change("lobe shift", LOADED)
    assert np.abs(lines[1:, 2]).min() > 10 * np.abs(np.delete(lines[1:], 2, axis=1)).max()


def test_turning_is_periodic_and_exact() -> None:
    field = np.random.default_rng(1).normal(size=(3, 40))
    np.testing.assert_allclose(turned(field, 3 * 2 * np.pi / 40), np.roll(field, 3, axis=1), atol=1e-12)
    np.testing.assert_allclose(turned(field, 2 * np.pi), field, atol=1e-12)


def test_uneven_sleeve_with_two_waves_shows_in_the_torque_bridge(change: Change) -> None:
    """Order 2 in a pattern of four waves: alike in s1 to s4, twice as much and opposite in the all-round bridge."""
    order2 = change("sleeve 2", BASE)[:, 2]
    np.testing.assert_allclose(order2[1:] / order2[0], -0.5, atol=0.01)


@pytest.mark.parametrize(("n", "neighbour"), [(2, -1), (4, 1)])
def test_out_of_round_makes_offsets(change: Change, n: int, neighbour: int) -> None:
    lines = change(f"out of round {n}", BASE)
    assert lines[2, 0].real / lines[1, 0].real == pytest.approx(neighbour, rel=0.01)
    assert np.abs(lines[1:, 1:]).max() < 0.02 * np.abs(lines[1:, 0]).min()
    loaded = np.abs(change(f"out of round {n}", LOADED)[1:, 1:]).max()
    assert loaded > 5 * np.abs(lines[1:, 1:]).max()


def test_uneven_teeth_differ_by_parity_in_the_orders(change: Change) -> None:
    """Waves k +- n at order n; the collar feels few waves most: order 2 for three waves, 2 and 6 for four."""
    three, four = (np.abs(change(name, LOADED)[1:]).mean(axis=0) for name in ("teeth 3", "teeth 4"))
    assert three.argmax() == 2
    assert four.argmax() == 2
    assert four[6] > 10 * four[4]
    assert three[4] > 10 * three[6]


@pytest.mark.parametrize(
    ("name", "order", "waves"), [("cage", 0.455, 1), ("ball pass", 10.3, 3), ("breathing", 10.3, 0)]
)
def test_bearing_order_travels_over_the_gauges(
    recordings: dict[tuple[object, Setting], Recording], name: str, order: float, waves: int
) -> None:
    def line(setting: Setting) -> np.ndarray:
        faulty, healthy = recordings[name, setting].channels, recordings["healthy", setting].channels
        added = np.array([faulty[sensor] - healthy[sensor] for sensor in SENSORS]).T
        angle = order * healthy["phi_in"]
        wave, *_ = np.linalg.lstsq(np.stack([np.cos(angle), np.sin(angle)], axis=1), added, rcond=None)
        return wave[0] - 1j * wave[1]

    base, loaded, fast = line(BASE), line(LOADED), line(FAST)
    assert np.abs(loaded[0]) == pytest.approx(1e-3 if waves == 0 else 0, rel=0.01)
    np.testing.assert_allclose(np.abs(loaded[1:]), 1e-3, rtol=0.01)
    np.testing.assert_allclose(np.abs(base[1:]), (0.3 + 0.7 * 0.1) * 1e-3, rtol=0.03)
    np.testing.assert_allclose(np.abs(fast[1:]), np.abs(base[1:]), rtol=0.03)
    np.testing.assert_allclose(loaded[2:] / loaded[1:4], np.exp(-0.5j * np.pi * waves), atol=0.01)


@pytest.mark.parametrize("kind", [fx.CircularSplineRunout, fx.BearingCage, fx.BallPass])
def test_every_recording_has_another_phase(kind: type[Effect]) -> None:
    rng = np.random.default_rng(3)
    effect = next(e for e in EFFECTS.values() if type(e) is kind)
    first, second = effect.drawn(rng), effect.drawn(rng)
    assert first != second
    assert 0 <= second.phase < 2 * np.pi


@pytest.mark.parametrize("kind", [fx.Coning, fx.LobeShift, fx.LoadSharing, fx.ThermalGrowth, fx.SpeedDeformation])
def test_laws_hold_at_the_limits_of_load_speed_and_temperature(kind: type[Effect]) -> None:
    """The largest sizes stay within the bounds of what they become at the most extreme point."""
    declared = quantities(kind)[size_of(kind)]
    for value in (declared.low, declared.high):
        for temperature in (-60, 150):
            kind(value).at(OperatingPoint(7300, 143), Conditions(temperature))
