"""Every kind of defect is found in recordings that have it, and none in good ones."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bench_fixtures import POINTS, all_with, cut, good, with_channel
from chain_fixtures import GEAR
from hypothesis import given, settings
from hypothesis import strategies as st

from swgsim.dataset.faults import FAULTS
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.gear.population import Population
from swgsim.recordings.checks.across import session_defects
from swgsim.recordings.checks.channel import plateau, runs
from swgsim.recordings.checks.defect import summary
from swgsim.recordings.checks.inspection import inspect
from swgsim.recordings.recording import Recording
from swgsim.studies.examples import EXAMPLES
from swgsim.tables.file_defect import FIRST_ROW

Recordings = tuple[Recording, ...]
Spoil = Callable[[Recordings], Recordings]


def kinds(recordings: Recordings) -> set[str]:
    return {defect.kind for defect in inspect(recordings)}


def of_all(change: Callable[[Recording], Recording]) -> Spoil:
    return lambda recordings: tuple(map(change, recordings))


# No false alarms.


def clean(recordings: Recordings) -> None:
    defects = inspect(recordings)
    assert not defects, summary(defects)


@pytest.mark.parametrize("label", ["healthy", *FAULTS])
def test_good_recordings_of_sound_and_faulty_gears_are_clean(label: str) -> None:
    clean(good(effects=() if label == "healthy" else (EXAMPLES[label],)))


def test_good_recordings_of_other_gears_are_clean() -> None:
    clean(tuple(each for gear in other_gears() for each in good(gear, POINTS[:3])))


def other_gears() -> tuple[Gear, ...]:
    """Gears drawn from a population, with gauges bonded poorly, with other deflection, and softer."""
    drawn = Population(count=3, gain=0.03, offset=0.05, position=0.02).draw(GEAR, 1)
    offset = (0.02, -0.05, 0.1, 0.03, -0.08)
    position = (0.02, -0.03, 0.03, 0.02, -0.02)
    bonded = replace(GEAR.gauges, offset=offset, position=position, gain=(0.95, 1.05, 1.02, 0.9, 1.1))
    return (
        *drawn,
        replace(GEAR, number=11, gauges=bonded),
        replace(GEAR, number=12, wave_generator=replace(GEAR.wave_generator, w0=0.4e-3)),
        replace(GEAR, number=13, transmission=replace(GEAR.transmission, b1=0.2, k1=3500.0)),
    )


@pytest.mark.parametrize("point", [OperatingPoint(200, 0), OperatingPoint(500, 143), OperatingPoint(7000, 20)])
def test_good_recordings_of_unusual_points_are_clean(point: OperatingPoint) -> None:
    clean(good(points=(point,)))


@pytest.mark.parametrize("quantum", [1e-4, 1e-3, 1e-2, 4e-2])
@pytest.mark.parametrize("per_turn", [150, 1000])
def test_a_coarsely_digitised_signal_is_not_clipped(quantum: float, per_turn: int) -> None:
    """The peaks of a slow or coarse signal are flat, with noise and without."""
    for each in good(points=POINTS[1:2], per_turn=per_turn):
        smooth = 0.3 + 0.17 * np.cos(2 * each.channels["phi_in"])
        for values in (each.channels["s1"], smooth, np.float64(np.float32(smooth))):
            rounded = quantum * np.round(values / quantum)
            assert "clipped" not in kinds((with_channel(each, "s1", rounded),))
            assert "stuck" not in kinds((with_channel(each, "s1", rounded),))


@pytest.mark.parametrize("steps", [360, 500, 4096])
@pytest.mark.parametrize("per_turn", [150, 2000])
def test_an_angle_in_steps_of_an_encoder_is_clean(steps: int, per_turn: int) -> None:
    step = 2 * np.pi / steps
    for each in good(points=POINTS[1:2], per_turn=per_turn):
        stepped = with_channel(each, "phi_in", step * np.floor(each.channels["phi_in"] / step))
        assert kinds((stepped,)) == {"no_repeats"}


def only(*kept: str) -> Spoil:
    return of_all(lambda each: replace(each, channels={name: each.channels[name] for name in kept}))


HARMLESS: dict[str, Spoil] = {
    "rounded time": lambda rs: tuple(replace(each, time=np.round(each.time, 6)) for each in rs),
    "wrapped angle": lambda rs: tuple(with_channel(r, "phi_in", r.channels["phi_in"] % (2 * np.pi)) for r in rs),
    "two gauges": lambda rs: only("phi_in", "s1", "s2")(rs),
    "no angle": lambda rs: only("s0", "s1", "s3")(rs),
    "no gauges": lambda rs: only("n_in", "T_in")(rs),
    "torque bridge": lambda rs: only("s0")(rs),
    # Order 2 does not separate these.
    "s1 and s3 swapped": lambda rs: swapped("s1", "s3")(rs),
    "s2 and s4 swapped": lambda rs: swapped("s2", "s4")(rs),
    "two pairs swapped": lambda rs: at_once(swapped("s1", "s2"), swapped("s3", "s4"))(rs),
}


@pytest.mark.parametrize("name", list(HARMLESS))
def test_harmless_changes_are_clean(name: str) -> None:
    assert not inspect(HARMLESS[name](good()))


# Every kind of defect.


def scaled(name: str, factor: float) -> Spoil:
    return lambda recordings: all_with(recordings, name, factor)


def swapped(a: str, b: str) -> Spoil:
    def swap(each: Recording) -> Recording:
        return replace(each, channels={**each.channels, a: each.channels[b], b: each.channels[a]})

    return of_all(swap)


def at_once(*spoils: Spoil) -> Spoil:
    def both(recordings: Recordings) -> Recordings:
        for spoil in spoils:
            recordings = spoil(recordings)
        return recordings

    return both


def one_load(recordings: Recordings) -> Recordings:
    return tuple(each for each in recordings if each.point.T_out == 39)


def of_first(change: Callable[[Recording], Recording]) -> Spoil:
    return lambda recordings: (change(recordings[0]), *recordings[1:])


def lost(each: Recording) -> np.ndarray:
    return ~np.isin(np.arange(len(each.time)), [400, 401, 900])


def lost_at_even_steps(each: Recording) -> Recording:
    shorter = cut(each, lost(each))
    return replace(shorter, time=each.time[: len(shorter.time)])


def jittered(share: float) -> Spoil:
    def jitter(each: Recording) -> Recording:
        step = each.time[1] - each.time[0]
        return replace(each, time=each.time + share * step * np.sin(1.0 + np.arange(len(each.time)) ** 2))

    return of_all(jitter)


def backwards_clock(each: Recording) -> Recording:
    time = each.time.copy()
    time[700] = time[690]
    return replace(each, time=time)


def stuck_from(name: str, start: int, length: int) -> Spoil:
    def stick(each: Recording) -> Recording:
        values = each.channels[name].copy()
        values[start : start + length] = values[start]
        return with_channel(each, name, values)

    return of_first(stick)


def test_noise_that_hits_one_level_four_times_is_not_clipped() -> None:
    """A peak of the speed with noise of three steps [rpm]."""
    values = np.array([
        2998.79, 2998.91, 2999.04, 2999.27, 2999.34, 2999.45, 2999.62, 2999.72, 2999.79, 2999.87, 2999.89, 3000.02,
        3000.05, 3000.05, 3000.05, 3000.05, 3000.04, 2999.99, 3000.00, 2999.98, 2999.81, 2999.70, 2999.67, 2999.48,
    ])  # fmt: skip
    assert plateau(values, *runs(values)) is None
    cut = np.minimum(values, 2999.9)
    assert plateau(cut, *runs(cut)) == 11


def clipped_at(name: str, share: float) -> Spoil:
    def clip(each: Recording) -> Recording:
        values = each.channels[name]
        middle, half = 0.5 * (values.max() + values.min()), 0.5 * np.ptp(values)
        return with_channel(each, name, np.minimum(values, middle + share * half))

    return of_first(clip)


def swinging(each: Recording) -> Recording:
    phi = each.channels["phi_in"]
    return with_channel(each, "phi_in", phi + 0.3 * np.sin(5 * phi))


def half_wrong(each: Recording) -> Recording:
    return replace(each, point=OperatingPoint(each.point.n_in_rpm, each.point.T_out + 5))


def three_loads(each: Recording) -> Recording:
    loads = np.repeat([0.2, 1.0, 1.8], len(each.time) // 3 + 1)[: len(each.time)]
    return with_channel(each, "T_out", each.channels["T_out"] * loads)


def two_speeds(each: Recording) -> Recording:
    """Slower by a fifth, then faster, with the set speed as the mean."""
    rates = np.where(np.arange(len(each.time)) < len(each.time) / 2, 0.8, 1.2)
    step = each.point.omega_in / each.rate
    return with_channel(each, "phi_in", each.channels["phi_in"][0] + step * np.cumsum(rates))


REFUSED: dict[str, tuple[Spoil, str, str]] = {
    "angle in degrees": (scaled("phi_in", 180 / np.pi), "angle_in_degrees", "phi_in"),
    "wrapped angle in degrees": (
        of_all(lambda each: with_channel(each, "phi_in", np.degrees(each.channels["phi_in"]) % 360)),
        "angle_in_degrees", "phi_in",
    ),
    "angle in revolutions": (scaled("phi_in", 0.5 / np.pi), "angle_in_revolutions", "phi_in"),
    "wrapped angle in revolutions": (
        of_all(lambda each: with_channel(each, "phi_in", each.channels["phi_in"] / (2 * np.pi) % 1)),
        "angle_in_revolutions", "phi_in",
    ),
    "angle backwards": (scaled("phi_in", -1), "angle_backwards", "phi_in"),
    "angle of the output": (scaled("phi_in", 1 / 101), "angle_against_set_speed", "phi_in"),
    "angle that swings": (of_first(swinging), "angle_turns_back", "phi_in"),
    "time in milliseconds": (
        of_all(lambda each: replace(each, time=1000 * each.time)), "angle_against_set_speed", "phi_in",
    ),
    "speed in rad/s": (scaled("n_in", 2 * np.pi / 60), "speed_in_rad_s", "n_in"),
    "speed in revolutions per second": (scaled("n_in", 1 / 60), "speed_in_rev_s", "n_in"),
    "speed of the output": (scaled("n_in", 1 / 101), "speed_against_set_speed", "n_in"),
    "speed backwards": (scaled("n_in", -1), "speed_backwards", "n_in"),
    "set speed in rad/s": (
        of_all(lambda each: replace(each, point=OperatingPoint(each.point.omega_in, each.point.T_out))),
        "angle_against_set_speed", "phi_in",
    ),
    "output torque in mN m": (scaled("T_out", 1e3), "torque_unit", "T_out"),
    "output torque in kN m": (scaled("T_out", 1e-3), "torque_unit", "T_out"),
    "output torque in pound-feet": (at_once(one_load, scaled("T_out", 0.73756)), "torque_unit", "T_out"),
    "output torque of the other sign": (scaled("T_out", -1), "torque_sign", "T_out"),
    "output torque with a zero offset": (of_all(half_wrong), "torque_against_set_load", "T_out"),
    "three loads, of which one is the mean": (at_once(one_load, of_all(three_loads)), "unsteady_load", "T_out"),
    "two speeds about the set speed": (of_first(two_speeds), "unsteady_speed", "phi_in"),
    "input torque in mN m": (scaled("T_in", 1e3), "torque_unit", "T_in"),
    "input torque of the other sign": (scaled("T_in", -1), "torque_unit", "T_in"),
    "gauge in V/V": (scaled("s2", 1e-3), "gauge_in_v_v", "s2"),
    "gauge in um/m": (scaled("s4", 1e3), "gauge_in_um_m", "s4"),
    "torque bridge in um/m": (scaled("s0", 500), "gauge_in_um_m", "s0"),
    "torque bridge in V/V": (scaled("s0", 1e-3), "gauge_scale", "s0"),
    "lost samples": (of_first(lambda each: cut(each, lost(each))), "samples_dropped", "t"),
    "lost samples at even steps": (of_first(lost_at_even_steps), "angle_jumps", "phi_in"),
    "clock backwards": (of_first(backwards_clock), "clock_backwards", "t"),
    "clock that jitters much": (jittered(0.2), "clock_jitter", "t"),
    "clipped much": (clipped_at("s3", 0.2), "clipped", "s3"),
    "clipped torque": (clipped_at("T_out", 0.6), "clipped", "T_out"),
    "gauge stuck for a while": (stuck_from("s3", 300, 60), "stuck", "s3"),
    "gauge stuck throughout": (stuck_from("s0", 0, 10**6), "stuck", "s0"),
    "angle stuck": (stuck_from("phi_in", 0, 10**6), "stuck", "phi_in"),
    "inverted gauge": (scaled("s2", -1), "gauge_inverted", "s2"),
    "inverted torque bridge": (scaled("s0", -1), "gauge_inverted", "s0"),
    "two opposite gauges inverted": (at_once(scaled("s1", -1), scaled("s3", -1)), "gauge_inverted", "s3"),
    "all gauges inverted": (
        at_once(*(scaled(f"s{i}", -1) for i in range(5))), "gauges_against_load", "",
    ),
    "swapped neighbours": (swapped("s1", "s2"), "gauges_swapped", "s1 s2"),
    "swapped neighbours across the number": (swapped("s4", "s1"), "gauges_swapped", "s1 s4"),
    "inverted gauge at one load": (at_once(one_load, scaled("s4", -1)), "gauge_inverted", "s4"),
    "swapped or inverted at one load": (
        at_once(one_load, swapped("s2", "s3")), "gauges_swapped_or_inverted", "s2 s3",
    ),
    "the same twice": (lambda rs: (*rs, replace(rs[0], name="copy", repeat=9)), "same_twice", ""),
}  # fmt: skip


# Defects that make other channels implausible too.
SPREADING = (
    "set speed in rad/s", "time in milliseconds", "torque bridge in um/m", "lost samples at even steps",
    "angle in degrees", "gauge stuck for a while",
)  # fmt: skip


@pytest.mark.parametrize("name", list(REFUSED))
def test_a_spoiled_recording_is_refused_by_its_name(name: str) -> None:
    spoil, kind, channel = REFUSED[name]
    found = [defect for defect in inspect(spoil(good())) if defect.severity == "refuse"]
    sides = {tuple(sorted(channel.split())), tuple(sorted({"s1", "s2", "s3", "s4"} - set(channel.split())))}
    if kind.startswith("gauges_swapped"):  # The swapped pair is unknown.
        assert {(defect.kind, tuple(sorted(defect.channel.split())) in sides) for defect in found} == {(kind, True)}
    else:
        assert (kind, channel) in {(defect.kind, defect.channel) for defect in found}
    assert all(defect.found and defect.expected and defect.remedy for defect in found)
    if name not in SPREADING:
        assert {defect.channel for defect in found if defect.kind != kind} <= {channel, *channel.split()}


WARNED: dict[str, tuple[Spoil, str, str]] = {
    "clipped gauge": (clipped_at("s1", 0.9), "clipped", "s1"),
    "clipped on both sides": (at_once(clipped_at("s1", 0.9), scaled("s1", -1), clipped_at("s1", 0.9)), "clipped", "s1"),
    "clock that jitters": (jittered(0.05), "clock_jitter", "t"),
    "speed a little off": (scaled("n_in", 1.05), "speed_against_set_speed", "n_in"),
    "angle a little off": (scaled("phi_in", 1.05), "angle_against_set_speed", "phi_in"),
    "torque a little off": (at_once(one_load, scaled("T_out", 1.1)), "torque_against_set_load", "T_out"),
    "speed that is only set": (scaled("n_in", 0), "constant", "n_in"),
    "gain": (scaled("s1", 2.5), "gauge_gain", "s1"),
    "gauge off its place": (
        of_all(lambda each: with_channel(each, "s1", np.roll(each.channels["s1"], 12))), "gauge_position", "s1",
    ),
    "noise in place of a gauge": (
        of_all(lambda each: with_channel(each, "s1", np.sin(np.arange(len(each.time)) ** 2.0))),
        "gauge_without_order_2",
        "s1",
    ),
    "short": (of_first(lambda each: cut(each, np.arange(len(each.time)) < 600)), "short", ""),
    "no repeats": (lambda rs: rs[::2], "no_repeats", ""),
    "same number of repeat": (of_all(lambda each: replace(each, repeat=1)), "repeat_twice", ""),
    "no temperature": (of_all(lambda each: replace(each, conditions=Conditions())), "no_temperature", ""),
}  # fmt: skip


@pytest.mark.parametrize("name", list(WARNED))
def test_a_doubtful_recording_causes_a_warning(name: str) -> None:
    spoil, kind, channel = WARNED[name]
    assert (kind, channel, "warn") in {(d.kind, d.channel, d.severity) for d in inspect(spoil(good()))}


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_infinite_numbers_are_named_and_excluded(value: float) -> None:
    spoiled = good()[0].channels["s1"].copy()
    spoiled[17] = value
    (defect,) = inspect((with_channel(good()[0], "s1", spoiled), *good()[1:]))
    assert (defect.kind, defect.channel, defect.row) == ("not_finite", "s1", 17 + FIRST_ROW)


def test_too_few_samples_are_named() -> None:
    found = inspect((cut(good()[0], np.arange(len(good()[0].time)) < 5), *good()[1:]))
    assert [defect.kind for defect in found] == ["too_few_samples"]


@pytest.mark.parametrize(
    ("name", "row"), [("lost samples", 400), ("lost samples at even steps", 400), ("gauge stuck for a while", 300)]
)
def test_the_row_is_that_of_the_first_affected_sample(name: str, row: int) -> None:
    spoil, kind, _ = REFUSED[name]
    (defect,) = (d for d in inspect(spoil(good())) if d.kind == kind)
    assert defect.row == row + FIRST_ROW


@given(where=st.integers(30, 1700), count=st.integers(1, 4), which=st.integers(0, 11))
@settings(max_examples=15, deadline=None)
def test_samples_lost_anywhere_are_found(where: int, count: int, which: int) -> None:
    each = good()[which]
    gap = cut(each, (np.arange(len(each.time)) < where) | (np.arange(len(each.time)) >= where + count))
    assert "samples_dropped" in kinds((gap,))
    assert "angle_jumps" in kinds((replace(gap, time=each.time[: len(gap.time)]),))


def test_most_gauges_inverted_are_named() -> None:
    inverted = ("s0", "s1", "s2", "s4")
    found = inspect(at_once(*(scaled(sensor, -1) for sensor in inverted))(good()))
    assert {(defect.kind, defect.channel) for defect in found} == {("gauge_inverted", sensor) for sensor in inverted}


def test_a_session_of_the_commissioning_is_told() -> None:
    recordings = tuple(replace(each, session="tuesday") for each in good())
    monday = tuple(replace(each, session="monday") for each in good())
    (warning,) = session_defects((*monday[1:], *recordings), monday)
    assert (warning.kind, warning.severity, warning.recording) == ("session_of_commissioning", "warn", monday[1].name)
    assert "'monday'" in warning.found
    assert not list(session_defects(recordings, monday))


def test_the_page_for_people_names_every_defect() -> None:
    page = (Path(__file__).parents[2] / "docs" / "recordings.md").read_text()
    for _, kind, _ in (*REFUSED.values(), *WARNED.values()):
        assert f"`{kind}`" in page


def test_a_summary_has_one_line_for_a_defect_of_many_recordings() -> None:
    defects = [d for d in inspect(all_with(good(), "phi_in", 180 / np.pi)) if d.kind == "angle_in_degrees"]
    assert len(defects) == len(good())
    text = summary(defects)
    assert text.count("\n") == 0
    assert f"also in {len(good()) - 1} others" in text
