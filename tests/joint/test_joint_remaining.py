"""The residual: laws of lines, differences between days, and the gear ratio."""

from dataclasses import replace

import numpy as np
import pytest
from joint_fixtures import VISCOUS, Hidden, sessions, trajectories
from scipy.stats import binom

from swgsim.common.seeds import generator
from swgsim.joint.days import days, no_days
from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.ladder import Ladder, Trial
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Table, fit
from swgsim.joint.remaining import RemainingLine, remaining
from swgsim.joint.report import gear_ratio
from swgsim.joint.textbook import textbook
from swgsim.joint.validation import Validation

pytestmark = pytest.mark.end_to_end

RUNS = sessions("remaining", names="AB", seconds=3.0)
DRAWS = 20


def lines_of(recordings: tuple[JointRecording, ...], of: str = "T_sensor") -> tuple[RemainingLine, ...]:
    table = Table(recordings, of)
    return remaining([(fit(table, textbook(recordings, of)), table)])


def with_line(each: JointRecording, frequency: float, size: float = 0.05) -> JointRecording:
    added = each.signals["T_sensor"] + size * np.cos(2 * np.pi * frequency * each.time + 1.0)
    return replace(each, signals={**each.signals, "T_sensor": added})


@pytest.mark.parametrize(("fixed", "order"), [(200.0, -700.0), (60.0, 0.0), (0.0, 300.0)])
def test_the_law_of_a_line_is_found(fixed, order):
    recordings = tuple(with_line(each, fixed + order * each.speed.mean() / (2 * np.pi)) for each in RUNS)
    (line,) = lines_of(recordings)
    assert line.fixed == pytest.approx(fixed, abs=2)
    assert line.order == pytest.approx(order, abs=15)
    assert line.amplitude == pytest.approx(0.05, rel=0.2)
    assert len(line.runs) >= 6


def sampled(each: JointRecording, wander: float) -> JointRecording:
    """The torque of a wave of order 700 as a slower clock of 250 Hz holds it, which wanders by so many radians in a
    root of a second.
    """
    rng = generator("slower clock", each.name, wander)
    steps = rng.normal(size=len(each)) * wander / (2 * np.pi * np.sqrt(each.rate))
    ticks = np.floor(250.0 * each.time + np.cumsum(steps) + rng.uniform())
    # The value of the first sample of a tick is held.
    held = np.searchsorted(ticks, ticks)
    torque = 0.03 * np.cos(700 * each.signals["q"][held] - 0.7)
    return replace(each, signals={**each.signals, "T_sensor": each.signals["T_sensor"] + torque})


@pytest.mark.parametrize(("wander", "lasts"), [(0.0, True), (3.0, False)])
def test_the_alias_of_a_wave_in_a_slower_clock_is_described_with_its_coherence(wander, lasts):
    """A line that keeps its phase is predicted from one half of a run to the other."""
    speeds = (0.33, 0.47, 0.61, 0.74, 0.9)
    recordings = tuple(sampled(each, wander) for each in sessions("clock", names="AB", speeds=speeds, rate=870.0))
    table = Table(recordings, "T_sensor")
    wave = fit(table, (*textbook(recordings, "T_sensor"), Ripple(order=700.0, corner=110.0, damping=0.7)))
    line = next(each for each in remaining([(wave, table)]) if each.order < 0)
    assert line.fixed == pytest.approx(250, rel=0.02)
    assert line.order == pytest.approx(-700, rel=0.03)
    assert line.gain > 0.1 if lasts else line.gain < 0
    assert ("lowers the error of the other" in str(line)) == lasts


def test_lines_without_a_law_are_given_none():
    false = 0
    for draw in range(DRAWS):
        rng = generator("lines without a law", draw)
        recordings = RUNS[: len(RUNS) // 2]
        for _ in range(3):
            recordings = tuple(with_line(each, float(rng.uniform(20, 220))) for each in recordings)
        false += bool(lines_of(recordings))
    assert false <= binom.ppf(0.995, DRAWS, 0.05)


def test_noise_has_no_lines():
    assert not lines_of(RUNS)


def by_day(recordings: tuple[JointRecording, ...]) -> float:
    table = Table(recordings, "current")
    found = days(fit(table, textbook(recordings, "current")), [table])
    assert found is not None
    return found.chance


def test_days_differ_where_their_friction_does_and_not_where_runs_do():
    stiffer = sessions("days", names="A"), sessions("days", Hidden(sublinear=0.5), names="B")
    assert by_day((*stiffer[0], *stiffer[1])) < 1e-3
    scattered = [
        by_day(sessions(("days", draw), Hidden(scatter=0.05), names="AB", seconds=2.0)) for draw in range(DRAWS)
    ]
    assert (np.array(scattered) < 0.01).sum() <= 2


def test_two_runs_give_the_friction_of_their_day_without_an_interval():
    """The lubricant of day2 is thinner."""
    recordings = []
    for number, each in enumerate(trajectories("days", seconds=10.0)):
        session, thin = ("day1", 0.0) if number < 2 else ("day2", 0.4 * VISCOUS)
        current = each.signals["current"] - thin * each.signals["omega"]
        recordings.append(replace(each, session=session, signals={**each.signals, "current": current}))
    table = Table(tuple(recordings[:4]), "current")
    found = days(fit(table, textbook(table.recordings, "current")), [table])
    assert found is not None
    assert found.chance is None
    assert [(day.runs, day.deviation) for day in found.days] == [(2, None)] * 2
    assert found.days[1].share / found.days[0].share == pytest.approx(0.6, abs=0.1)


def test_sessions_that_show_no_friction_of_their_own_are_explained():
    assert "torque sensor" in no_days([Table(RUNS, "T_sensor")])
    assert "one session" in no_days([Table(RUNS[:1], "current")])


def test_one_run_says_nothing_of_its_day():
    table = Table((RUNS[3], RUNS[11]), "current")
    assert days(fit(table, textbook(table.recordings, "current")), [table]) is None


@pytest.mark.parametrize(
    ("orders", "ratio"),
    [((700.0, 1200.0), 100), ((200.0, 400.0, 700.0), 100), ((202.0, 1010.0), 202), ((1200.0,), None)],
)
def test_the_gear_ratio_divides_all_fast_orders(orders, ratio):
    table = Table(tuple(replace(each, gear_ratio=None) for each in RUNS), "T_sensor")
    start = fit(table, textbook(table.recordings, "T_sensor"))
    steps = tuple(Trial(Ripple(order=order), start, 0.1, 0.1, 1e-9) for order in (8.0, *orders))
    found = gear_ratio(Validation(Ladder(start, steps, ()), table, None))
    assert (found and found["value"]) == (ratio and pytest.approx(ratio))
    if found:
        assert found["ci95"][0] < ratio < found["ci95"][1]
