"""Effects on gauges and acquisition: which orders, which pattern over the gauges, and which law in load and speed."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR, SECTORS

import swgsim.effects as fx
from swgsim.chain.chain import Run, channels_of, simulate, simulate_turns
from swgsim.effects.base import Effect, Scene
from swgsim.effects.one_gauge import ALL
from swgsim.effects.quantity import quantities
from swgsim.effects.signal_hysteresis import PLAYS
from swgsim.gear.acquisition import Window
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

TURNS, POINTS = 12, 150
IDLE, LOADED, FAST = OperatingPoint(2000, 7), OperatingPoint(2000, 70), OperatingPoint(4000, 70)
FRESH, LATE = Conditions(), Conditions(temperature=45, elapsed=1800)
EFFECTS = (
    fx.GaugePosition(1, 0.02),
    fx.GaugeDirection(1, 0.02),
    fx.GaugeGain(1, 0.02),
    fx.ZeroOffset(1, 0.02),
    fx.ThermalOutput(1, 2e-4),
    fx.GaugeFactorTemperature(1e-4),
    fx.BondCreep(0.001),
    fx.SignalHysteresis(0.02),
    fx.TorqueNonlinearity(0.01),
    fx.BridgeNonlinearity(0.01),
    fx.SelfHeating(0.01),
    fx.TiltingMoment(0.01, 0.4),
    fx.AxialThrust(0.002),
    fx.BoltPreload(0.01),
    fx.ChannelCrosstalk(1, 0.02),
    fx.ChannelSkew(50e-6),
    fx.FilterMismatch(1, 20e-6),
    fx.AmplifierDrift(0.002),
    fx.Debonding(1, 0.02),
    fx.EncoderEccentricity(0.002, 0.5),
    fx.MainsHum(0.001, 50.0, 0.3),
    fx.MotorPickup(5, 0.001, 0.4),
    fx.SubOrders(2, 0.001, 0.1, 0.9, 1.7, 2.5, 3.3),
    fx.Clipping(0.25),
    fx.FlangeGain(0.01),
    fx.FlangeZero(0.005),
)
NAMED = {effect.name(): effect for effect in EFFECTS}
# The same effects where a choice is another one.
VARIANTS: Mapping[str, Effect] = {
    "gain of all": fx.GaugeGain(ALL, 0.02),
    "thermal output of all": fx.ThermalOutput(ALL, 2e-4),
    "cubic": fx.TorqueNonlinearity(0.01, power=3),
    "cubic bridge": fx.BridgeNonlinearity(0.01, sensor=1, power=3),
    "moment with the load": fx.TiltingMoment(0.01, 0.4, with_load=1),
    "thrust on s0": fx.AxialThrust(0.002, on_s0=1),
    "hum of one": fx.MainsHum(0.001, 50.0, 0.3, sensor=1),
    "encoder beside": fx.EncoderEccentricity(0.002, 0.5, tells_speed=0),
    "input flange": fx.FlangeGain(0.01, at_input=1),
}
Key = tuple[str, OperatingPoint, Conditions]


@pytest.fixture(scope="module")
def recordings() -> Mapping[Key, Recording]:
    """Every effect at every operating point, late in a warm session and, once, in a fresh one; all in one go."""
    runs: dict[Key, Run] = {}
    for name, effects in {"healthy": (), **{n: (effect,) for n, effect in (NAMED | VARIANTS).items()}}.items():
        for point, conditions in ((IDLE, LATE), (LOADED, LATE), (FAST, LATE), (LOADED, FRESH)):
            runs[name, point, conditions] = Run(GEAR, point, effects, conditions=conditions)
    runs["leading", FAST, LATE] = Run(GEAR, FAST, (fx.FilterMismatch(1, -20e-6),))
    runs["backwards", FAST, LATE] = Run(GEAR, FAST, (fx.ChannelSkew(-50e-6),))
    return dict(zip(runs, simulate_turns(list(runs.values()), TURNS, POINTS, SECTORS), strict=True))


Recordings = Mapping[Key, Recording]


def lines(recording: Recording) -> np.ndarray:
    """Complex amplitude (sensor, order times 12) of every gauge; the mean is order 0."""
    amplitude = np.fft.rfft([recording.channels[s] for s in SENSORS]) / len(recording.time)
    amplitude[:, 1:] *= 2
    return amplitude


def order(
    recordings: Recordings, name: str, k: float, point: OperatingPoint = LOADED, conditions: Conditions = LATE
) -> np.ndarray:
    """Complex amplitude of order k of the five gauges."""
    return lines(recordings[name, point, conditions])[:, round(k * TURNS)]


def change(
    recordings: Recordings, name: str, k: float, point: OperatingPoint = LOADED, conditions: Conditions = LATE
) -> np.ndarray:
    """What the effect adds to order k of the five gauges."""
    return order(recordings, name, k, point, conditions) - order(recordings, "healthy", k, point, conditions)


def changed(recordings: Recordings, name: str, point: OperatingPoint = LOADED) -> list[float]:
    """The orders whose lines change by more than a thousandth of the largest change, largest first."""
    added = lines(recordings[name, point, LATE]) - lines(recordings["healthy", point, LATE])
    size = np.abs(added).max(axis=0)
    return [k / TURNS for k in np.argsort(-size).tolist() if size[k] > 1e-3 * size.max()]


def lag(recordings: Recordings, name: str, k: int, point: OperatingPoint = LOADED) -> np.ndarray:
    """Angle [rad] by which order k of the five gauges comes later than without the effect."""
    return -np.angle(order(recordings, name, k, point) / order(recordings, "healthy", k, point))


ONE_GAUGE = [name for name, effect in NAMED.items() if getattr(effect, "sensor", ALL) != ALL]


@pytest.mark.parametrize("name", ONE_GAUGE)
def test_effects_on_one_gauge_leave_the_others_alone(recordings: Recordings, name: str) -> None:
    added = lines(recordings[name, LOADED, LATE]) - lines(recordings["healthy", LOADED, LATE])
    assert np.abs(added[1]).max() > 1e-4
    assert np.abs(np.delete(added, 1, axis=0)).max() < 1e-12


def test_a_shifted_gauge_lags_by_order_times_shift(recordings: Recordings) -> None:
    for point in (IDLE, LOADED, FAST):
        assert lag(recordings, "gauge_position", 2, point)[1] == pytest.approx(2 * 0.02, rel=0.02)
    assert abs(change(recordings, "gauge_position", 0)[1]) < 1e-5
    assert changed(recordings, "gauge_position")[0] == 2


def test_a_turned_gauge_gets_order_two_in_quadrature_and_keeps_its_mean(recordings: Recordings) -> None:
    share = change(recordings, "gauge_direction", 2)[1] / order(recordings, "healthy", 2)[1]
    assert share.imag == pytest.approx(0.02 * 180 / np.pi * 0.078, rel=0.02)
    assert abs(share.real) < 0.1 * abs(share.imag)
    mean = change(recordings, "gauge_direction", 0)[1] / order(recordings, "healthy", 0)[1]
    assert abs(mean) < 2 * 0.02**2 * 1.1


@pytest.mark.parametrize(
    ("name", "share", "rtol"),
    [
        ("gauge_gain", 0.02 * np.eye(5)[1], 1e-6),
        ("gain of all", np.full(5, 0.02), 1e-7),
        ("gauge_factor_temperature", np.full(5, 1e-4 * 20), 1e-3),
        ("amplifier_drift", np.full(5, 0.002 * 1800 / 3600), 1e-3),
        ("debonding", -0.02 * 1800 / 3600 * np.eye(5)[1], 1e-3),
    ],
)
def test_a_gain_scales_the_mean_and_all_orders(
    recordings: Recordings, name: str, share: np.ndarray, rtol: float
) -> None:
    """At every load and speed; those of temperature and time not in a fresh session."""
    for point in (IDLE, LOADED, FAST):
        for k in (0, 1, 2, 4):
            found = change(recordings, name, k, point) / order(recordings, "healthy", k, point)
            np.testing.assert_allclose(found, share, rtol=rtol, atol=1e-9)
    if not name.startswith("ga") or name == "gauge_factor_temperature":
        limit = 1e-6 if name == "debonding" else 1e-7
        assert np.abs(change(recordings, name, 2, conditions=FRESH)).max() < limit


FIELD = np.array([0, np.cos(0.4), np.sin(0.4), -np.cos(0.4), -np.sin(0.4)])


@pytest.mark.parametrize(
    ("name", "added", "fresh"),
    [
        ("zero_offset", 0.02 * np.eye(5)[1], 1),
        ("thermal_output", 2e-4 * 20 * np.eye(5)[1], 0),
        ("thermal output of all", np.full(5, 2e-4 * 20), 0),
        ("self_heating", np.full(5, 0.01), 0.01),
        ("tilting_moment", 0.01 * FIELD, 1),
        ("bolt_preload", 0.01 * np.array([0, 1, -1, 1, -1]), 1),
    ],
)
def test_a_zero_moves_the_mean_only(recordings: Recordings, name: str, added: np.ndarray, fresh: float) -> None:
    """By the same at every load and speed; ``fresh`` is the share of it in a fresh session, at most."""
    for point in (IDLE, LOADED, FAST):
        np.testing.assert_allclose(change(recordings, name, 0, point), added, rtol=1e-6, atol=1e-12)
    assert changed(recordings, name) == [0]
    left = np.abs(change(recordings, name, 0, conditions=FRESH)).max()
    assert left <= fresh * np.abs(added).max() * (1 + 1e-6) + 1e-15


def test_creep_grows_the_means_with_time_and_load_only(recordings: Recordings) -> None:
    for point in (IDLE, LOADED):
        added = change(recordings, "bond_creep", 0, point) / order(recordings, "healthy", 0, point)
        np.testing.assert_allclose(added, 0.001 * (1 - np.exp(-1800 / 900)), rtol=1e-3)
    assert changed(recordings, "bond_creep") == [0]
    assert np.abs(change(recordings, "bond_creep", 0, conditions=FRESH)).max() < 1e-6


def test_hysteresis_lags_alike_at_all_speeds_and_makes_order_six(recordings: Recordings) -> None:
    for point in (LOADED, FAST):
        np.testing.assert_allclose(lag(recordings, "signal_hysteresis", 2, point)[1:], 0.849 * 0.02, rtol=0.03)
        amplitude = np.abs(order(recordings, "healthy", 2, point))
        np.testing.assert_allclose(
            np.abs(change(recordings, "signal_hysteresis", 6, point) / amplitude)[1:], 0.170 * 0.02, rtol=0.05
        )
    assert np.abs(change(recordings, "signal_hysteresis", 0)[1:]).max() < 1e-4


def test_hysteresis_is_settled_from_the_first_sample(recordings: Recordings) -> None:
    signal = recordings["signal_hysteresis", LOADED, LATE].channels["s1"].reshape(TURNS, POINTS)
    np.testing.assert_allclose(signal, signal[:1].repeat(TURNS, axis=0), rtol=0, atol=1e-12)


def test_hysteresis_takes_every_sample_in_turn() -> None:
    """However often a signal turns back, and after one revolution ahead."""
    time, turn = np.arange(40) * 2 * np.pi / LOADED.omega_in / 30, 30
    signals = np.random.default_rng(2).standard_normal((5, 40))
    found = fx.SignalHysteresis(0.02).gauge(signals, Scene(time, 0 * time, 0 * time, LOADED, Conditions()))
    reach = np.ptp(signals, axis=1) / 2
    x = signals - (signals.max(axis=1) - reach)[:, None]
    radii, play, held = reach[:, None] * (np.arange(PLAYS) + 0.5) / PLAYS, np.zeros((5, PLAYS)), []
    for i in (*range(turn), *range(40)):
        play = np.minimum(np.maximum(play, x[:, i, None] - radii), x[:, i, None] + radii)
        held.append(play.mean(axis=1))
    np.testing.assert_allclose(found, signals + 0.08 * (np.transpose(held[turn:]) - x / 2), rtol=1e-12)


@pytest.mark.parametrize(("name", "power"), [("torque_nonlinearity", 2), ("cubic", 3)])
def test_torque_nonlinearity_grows_with_a_power_of_the_load(recordings: Recordings, name: str, power: int) -> None:
    added = change(recordings, name, 0)
    np.testing.assert_allclose(added / order(recordings, "healthy", 0), 0.01, rtol=0.02)
    low = change(recordings, name, 0, IDLE)
    np.testing.assert_allclose(added / low, 10**power, rtol=0.03 * power)
    torque = recordings["healthy", LOADED, LATE].channels["T_out"]
    ripple = np.fft.rfft(torque)[2 * TURNS] * 2 / len(torque)
    two = change(recordings, name, 2)
    np.testing.assert_allclose(two / added, power * ripple / 70, rtol=0.02)


def test_bridge_nonlinearity_makes_order_four_and_couples_mean_to_order_two(recordings: Recordings) -> None:
    for point in (IDLE, LOADED):
        mean, two = order(recordings, "healthy", 0, point), order(recordings, "healthy", 2, point)
        four = change(recordings, "bridge_nonlinearity", 4, point)
        np.testing.assert_allclose(four[1:], 0.01 * two[1:] ** 2 / 2, rtol=0.05)
        np.testing.assert_allclose(
            change(recordings, "bridge_nonlinearity", 2, point)[1:], (0.02 * mean * two)[1:], rtol=0.1
        )
    assert change(recordings, "bridge_nonlinearity", 0)[0] == pytest.approx(
        0.01 * order(recordings, "healthy", 0)[0] ** 2, rel=0.01
    )


def test_a_cubic_bridge_makes_order_six_of_its_own_gauge(recordings: Recordings) -> None:
    """A wave of order 2 about a mean, cubed: a quarter of its cube at order 6, and with the mean an order 4."""
    mean, two = order(recordings, "healthy", 0)[1], order(recordings, "healthy", 2)[1]
    six, four = (change(recordings, "cubic bridge", k) for k in (6, 4))
    assert six[1] == pytest.approx(0.01 / 0.25 * two**3 / 4, rel=0.05)
    assert four[1] == pytest.approx(0.01 / 0.25 * 3 * mean * two**2 / 2, rel=0.05)
    assert np.abs(np.delete(six, 1)).max() == 0


def test_a_tilting_moment_may_follow_the_load(recordings: Recordings) -> None:
    for point in (IDLE, LOADED):
        expected = 0.01 * point.T_out / 70 * FIELD
        np.testing.assert_allclose(change(recordings, "moment with the load", 0, point), expected, atol=3e-5)


def test_axial_thrust_moves_four_gauges_alike_in_proportion_to_load(recordings: Recordings) -> None:
    np.testing.assert_allclose(change(recordings, "axial_thrust", 0), (0, *[0.002] * 4), rtol=2e-3)
    np.testing.assert_allclose(change(recordings, "axial_thrust", 0, IDLE), (0, *[0.0002] * 4), rtol=2e-2)
    np.testing.assert_allclose(change(recordings, "thrust on s0", 0), 0.002, rtol=2e-3)


def test_crosstalk_takes_from_order_two_and_gives_to_the_mean(recordings: Recordings) -> None:
    """The neighbour has order 2 in opposite phase and the same mean."""
    two = change(recordings, "channel_crosstalk", 2)[1] / order(recordings, "healthy", 2)[1]
    mean = change(recordings, "channel_crosstalk", 0)[1] / order(recordings, "healthy", 0)[1]
    assert two == pytest.approx(-0.02, rel=0.05)
    assert mean == pytest.approx(0.02, rel=0.01)


def test_skew_lags_with_channel_order_and_speed(recordings: Recordings) -> None:
    for point in (LOADED, FAST):
        expected = 2 * point.omega_in * 50e-6 * np.arange(5)
        np.testing.assert_allclose(lag(recordings, "channel_skew", 2, point), expected, atol=1e-4)
    np.testing.assert_allclose(lag(recordings, "backwards", 2, FAST), -expected, atol=1e-4)
    difference = lines(recordings["channel_skew", FAST, LATE])[[1, 3], 2 * TURNS] @ (1, -1)
    amplitude = abs(order(recordings, "healthy", 2, FAST)[1])
    assert abs(difference) / amplitude == pytest.approx(2 * 2 * FAST.omega_in * 50e-6, rel=0.01)


@pytest.mark.parametrize("name", ["channel_skew", "filter_mismatch"])
def test_delays_are_right_to_the_ends_of_the_window(recordings: Recordings, name: str) -> None:
    signals = np.array([recordings[name, FAST, LATE].channels[s] for s in SENSORS]).reshape(5, TURNS, POINTS)
    assert np.abs(signals - signals[:, 5:6]).max() < 2e-6


def test_skew_needs_no_whole_revolutions() -> None:
    """In a window of 3.3 revolutions, what is asked from before it is what comes a revolution later."""
    window = Window(rate=5000, samples=495)
    healthy, skewed = simulate(
        [Run(GEAR, LOADED), Run(GEAR, LOADED, (fx.ChannelSkew(50e-6),))], window, SECTORS
    ).signals
    shift = 4 * 50e-6 * LOADED.omega_in
    begin = (skewed - healthy)[4, :10]
    middle = (skewed - healthy)[4, 150:160]
    assert np.abs(begin - middle).max() < 0.02 * shift * np.abs(healthy[4]).max()


def test_a_lagging_filter_delays_with_speed_and_a_leading_one_is_its_inverse(recordings: Recordings) -> None:
    for point in (LOADED, FAST):
        expected = np.arctan(2 * point.omega_in * 20e-6)
        np.testing.assert_allclose(lag(recordings, "filter_mismatch", 2, point)[1], expected, rtol=1e-3)
    product = order(recordings, "filter_mismatch", 2, FAST) * order(recordings, "leading", 2, FAST)
    np.testing.assert_allclose(product[1], order(recordings, "healthy", 2, FAST)[1] ** 2, rtol=1e-4)
    assert abs(change(recordings, "filter_mismatch", 0)[1]) < 1e-12


def test_an_encoder_off_centre_modulates_speed_and_angle_but_not_the_gauges(recordings: Recordings) -> None:
    assert changed(recordings, "encoder_eccentricity") == []
    for point in (LOADED, FAST):
        seen, true = recordings["encoder_eccentricity", point, LATE], recordings["healthy", point, LATE]
        speed = np.fft.rfft(seen.channels["n_in"] - true.channels["n_in"])[TURNS] * 2 / len(seen.time)
        assert abs(speed) == pytest.approx(0.002 * point.n_in_rpm, rel=0.01)
        rate = np.gradient(seen.channels["phi_in"], seen.time) * 30 / np.pi
        np.testing.assert_allclose(rate[1:-1], seen.channels["n_in"][1:-1], rtol=2e-4)


def test_an_encoder_may_tell_the_angle_alone(recordings: Recordings) -> None:
    seen, true = (recordings[name, FAST, LATE].channels for name in ("encoder beside", "healthy"))
    assert [c for c in true if not np.array_equal(seen[c], true[c])] == ["phi_in"]


def test_over_the_measured_angle_order_two_gets_sidebands(recordings: Recordings) -> None:
    seen, true = recordings["encoder_eccentricity", LOADED, LATE], recordings["healthy", LOADED, LATE]
    even = 2 * np.pi * np.arange(TURNS * POINTS) / POINTS

    def over_angle(recording: Recording) -> np.ndarray:
        signal = np.interp(even, recording.channels["phi_in"], recording.channels["s1"], period=2 * np.pi * TURNS)
        return np.fft.rfft(signal)[[TURNS, 3 * TURNS]] * 2 / len(signal)

    sidebands = np.abs(over_angle(seen) - over_angle(true)) / abs(order(recordings, "healthy", 2)[1])
    np.testing.assert_allclose(sidebands, 0.002, rtol=0.05)


def test_hum_stays_at_its_frequency(recordings: Recordings) -> None:
    for point in (IDLE, LOADED, FAST):
        k = 50 * 60 / point.n_in_rpm
        np.testing.assert_allclose(change(recordings, "mains_hum", k, point), 0.001 * np.exp(0.3j), rtol=1e-6)
        assert changed(recordings, "mains_hum", point) == [k]
        one = change(recordings, "hum of one", k, point)
        np.testing.assert_allclose(one, 0.001 * np.exp(0.3j) * np.eye(5)[1], rtol=1e-6, atol=1e-12)


def test_pickup_is_locked_to_the_angle_and_alike_in_all_gauges(recordings: Recordings) -> None:
    for point in (IDLE, LOADED, FAST):
        np.testing.assert_allclose(change(recordings, "motor_pickup", 5, point), 0.001 * np.exp(0.4j), rtol=0.05)
        assert changed(recordings, "motor_pickup", point)[0] == 5


def test_sub_orders_have_a_phase_of_their_own_in_every_gauge(recordings: Recordings) -> None:
    expected = 0.001 * np.exp(1j * (np.array([0.1, 0.9, 1.7, 2.5, 3.3]) - np.pi / 2))
    for point in (IDLE, LOADED, FAST):
        np.testing.assert_allclose(change(recordings, "sub_orders", 0.5, point), expected, rtol=0.02)


@pytest.mark.parametrize(("name", "phases"), [("mains_hum", 1), ("sub_orders", 5)])
def test_random_phases_are_drawn_anew_and_nothing_else(name: str, phases: int) -> None:
    rng = np.random.default_rng(3)
    one, other = NAMED[name].drawn(rng), NAMED[name].drawn(rng)
    different = [f for f in quantities(type(one)) if getattr(one, f) != getattr(other, f)]
    assert len(different) == phases
    assert all(f.startswith("phase") for f in different)


def test_clipping_cuts_the_peaks_of_a_loaded_gear_only(recordings: Recordings) -> None:
    # Filtered, an edge overshoots a little.
    assert recordings["clipping", LOADED, LATE].channels["s1"].max() == pytest.approx(0.25, abs=5e-4)
    added = changed(recordings, "clipping")
    assert {0, 2, 4} < set(added)
    assert (change(recordings, "clipping", 0)[1:].real < 0).all()
    assert changed(recordings, "clipping", IDLE) == []


@pytest.mark.parametrize(
    ("name", "channel"), [("flange_gain", "T_out"), ("input flange", "T_in"), ("flange_zero", "T_in")]
)
def test_flanges_change_their_own_channel(recordings: Recordings, name: str, channel: str) -> None:
    for point in (IDLE, LOADED, FAST):
        seen, true = recordings[name, point, LATE].channels, recordings["healthy", point, LATE].channels
        assert [c for c in true if not np.array_equal(seen[c], true[c])] == [channel]
        share = seen[channel].mean() / true[channel].mean() - 1
        if name == "flange_zero":
            assert share * true[channel].mean() == pytest.approx(0.005)
        else:
            assert share == pytest.approx(0.01)


@pytest.mark.slow
def test_a_window_of_a_data_set_shows_acquisition_in_every_channel():
    """Also in those that are no gauges."""
    window = Window(samples=600)
    run = Run(GEAR, OperatingPoint(2000.0, 39.0))
    plain, acting = (
        channels_of(simulate([replace(run, effects=effects)], window, SECTORS), 0, 600)
        for effects in ((), (fx.FlangeGain(0.01), fx.FlangeZero(0.02)))
    )
    np.testing.assert_allclose(acting["T_out"], 1.01 * plain["T_out"])
    np.testing.assert_allclose(acting["T_in"], plain["T_in"] + 0.02)
    np.testing.assert_array_equal(acting["s1"], plain["s1"])
