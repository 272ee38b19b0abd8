"""The page of a joint and its pictures, on a small simulated joint and on one that moves to and fro."""

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from joint_fixtures import Hidden, Wave, steady, trajectories
from matplotlib.figure import Figure
from swgsim.joint.joint_page import page

from swgsim.joint import cases_page
from swgsim.joint.days import Day, Days, days
from swgsim.joint.effects.friction import StribeckFriction
from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.effects.slip import LoadDependentFriction
from swgsim.joint.figures import pictures
from swgsim.joint.figures.parts import pieces, short
from swgsim.joint.figures.spectrum import density
from swgsim.joint.figures.waves import modelled, seen
from swgsim.joint.judged import Judged
from swgsim.joint.ladder import Ladder, Trial
from swgsim.joint.naming import listed
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Table, fit
from swgsim.joint.remaining import RemainingLine
from swgsim.joint.report import report
from swgsim.joint.term import Term
from swgsim.joint.textbook import textbook

ORDER, SIZE, CORNER, DAMPING = 200.0, 0.05, 60.0, 0.4
RIPPLE = Hidden(ripple=(Wave(ORDER, SIZE),), corner=CORNER, damping=DAMPING, stribeck=(0.2, 0.1))
SPEEDS = (-0.6, 0.2, 0.6, 1.0, 1.5)
LINE = RemainingLine(120.0, -300.0, 0.01, 0.6, ("B 0.6",), -0.02)
NASTY = "<script>alert('R&D')</script>"


def judged(fitted: tuple[JointRecording, ...], held: tuple[JointRecording, ...], of: str, *tried: Term) -> Judged:
    """A ladder with the first term kept and the others refused, without the search."""
    table = Table(fitted, of)
    start = fit(table, textbook(table.recordings, of))
    kept = fit(table, (*start.terms, tried[0]))
    step = Trial(kept.terms[-1], kept, 0.5, 0.4, 1e-9)
    added = (fit(table, (*kept.terms, term)) for term in tried[1:])
    refused = tuple(Trial(each.terms[-1], each, 0.001, 0.0, 0.3) for each in added)
    return Judged(Ladder(start, (step,), refused), Table(held, of), 0.01)


@pytest.fixture(scope="module")
def runs() -> dict[str, tuple[JointRecording, ...]]:
    return {s: tuple(steady(v, "page", RIPPLE, s, seconds=2.0) for v in SPEEDS) for s in "AB"}


@pytest.fixture(scope="module")
def torque(runs: Mapping[str, tuple[JointRecording, ...]]) -> Judged:
    wave = Ripple(order=ORDER, corner=CORNER, damping=DAMPING)
    return judged(runs["A"], runs["B"], "T_sensor", wave, Ripple(order=3.0))


@pytest.fixture(scope="module")
def current(runs: Mapping[str, tuple[JointRecording, ...]]) -> tuple[Judged, Days]:
    found = judged(runs["A"], runs["B"], "current", StribeckFriction(v_s=0.1))
    by_day = days(found.ladder.top, (found.table, found.heldout))
    assert by_day is not None
    return found, by_day


@pytest.fixture(scope="module")
def trajectory() -> tuple[Judged, Days]:
    recordings = trajectories("page", Hidden(load=0.02), seconds=10.0)
    found = judged(recordings[:3], recordings[3:], "current", LoadDependentFriction(), Ripple(order=101.0))
    assert days(found.ladder.top, (found.table, found.heldout)) is None, "one run of a session says nothing of its day"
    by_day = Days(tuple(Day(each.session, 1.0, 0.05, 0.4, 0.03, 3) for each in recordings), 0.3)
    return replace(found, floor=None), by_day


def full(said: dict[str, Any]) -> dict[str, Any]:
    """A report as the job completes it."""
    return {
        **said,
        "defects": [],
        "seconds": 1.0,
        "noise_floor_how": "of recordings at rest",
        "split": {**said["split"], "left_out": []},
    }


def empty(figure: Figure) -> list[str]:
    """Panels that are shown and hold nothing."""
    panels = [axes for axes in figure.get_axes() if axes.get_visible()]
    holds: Callable[[Any], bool] = lambda axes: any(  # noqa: E731
        np.isfinite(np.asarray(line.get_ydata(), float)).any() for line in axes.lines if len(line.get_xdata())
    )
    return [axes.get_title(loc="left") for axes in panels if not holds(axes)]


def test_pictures_of_steady_runs_hold_something_and_name_their_axes(torque: Judged) -> None:
    drawn = pictures(torque, None, [LINE], report(torque, None, [LINE]))
    assert list(drawn) == ["ladder", "stretches", "spectrum", "runs", "waves", "unexplained"]
    for name, (picture, figure) in drawn.items():
        assert picture.png.startswith(b"\x89PNG")
        assert picture.caption.endswith(".")
        assert empty(figure) == [], name
        named = [axes.get_xlabel() + axes.get_ylabel() for axes in figure.get_axes() if axes.get_visible()]
        assert all("[" in text for text in named), (name, named)


def test_pictures_of_trajectories(trajectory: tuple[Judged, Days]) -> None:
    found, by_day = trajectory
    drawn = pictures(found, by_day, [], report(found, by_day, []))
    assert list(drawn) == ["ladder", "stretches", "spectrum", "runs", "friction"]
    assert all(empty(figure) == [] for _, figure in drawn.values())
    assert drawn["stretches"][1].get_axes()[0].get_xlabel() == "time [s]"


def test_ladder_shows_every_rung_and_the_floor(torque: Judged) -> None:
    said = report(torque, None, [])
    axes = pictures(torque, None, [], said)["ladder"][1].get_axes()[0]
    assert [tick.get_text().removeprefix("+ ") for tick in axes.get_yticklabels()] == [
        r["title"] for r in said["rungs"]
    ]
    shown = np.concatenate([np.asarray(line.get_xdata(), float) for line in axes.lines])
    for rung in said["rungs"]:
        assert np.isclose(shown, rung["heldout"]).any()
        assert not rung["kept"] or np.isclose(shown, rung["fit"]).any()
    assert np.isclose(shown, torque.floor).any()


def test_ripple_is_measured_in_every_run_as_it_was_made(torque: Judged) -> None:
    points = seen(torque, ORDER)
    assert {point.session for point in points} == {"A", "B"}
    assert {point.heldout for point in points} == {False, True}
    # The response of the second-order filter by its textbook formula; backward runs are mirrored onto it.
    for point in points:
        x = point.frequency / CORNER
        made = SIZE * np.exp(-0.7j) / (1 - x**2 + 2j * DAMPING * x)
        assert abs(point.value - made) < 0.03 * SIZE + 3 * point.noise, point
    omega = np.array([0.2, 1.0])
    x = ORDER * omega / (2 * np.pi) / CORNER
    assert np.allclose(modelled(torque, ORDER, omega), SIZE * np.exp(-0.7j) / (1 - x**2 + 2j * DAMPING * x), atol=0.003)


def test_friction_points_lie_on_the_lines_of_their_session(current: tuple[Judged, Days]) -> None:
    found, by_day = current
    over, beside = pictures(found, by_day, [], report(found, by_day, []))["friction"][1].get_axes()
    points = [line for line in over.lines if len(line.get_xdata()) == 1]
    assert len(points) == 2 * len(SPEEDS)
    curves = [line for line in over.lines if len(line.get_xdata()) > 1]
    for line in points:
        (v,), (y,) = np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)
        # Stribeck friction adds to the Coulomb friction of slow runs.
        assert min(abs(y - np.interp(v, *curve.get_data())) for curve in curves) < 0.05, v
    assert [tick.get_text() for tick in beside.get_xticklabels()] == ["A", "B"]


def test_density_holds_the_power_of_white_noise_and_of_no_mean() -> None:
    recordings = tuple(steady(v, "density", seconds=8.0) for v in (0.2, 0.5))
    table = Table(recordings, "T_sensor")
    residual = 3.0 + 0.1 * np.random.default_rng(5).normal(size=len(table.signal))
    f, power = density(table, residual)
    assert np.trapezoid(power, f) == pytest.approx(0.01, rel=0.1)


def test_pieces_of_a_run_are_the_run_and_those_of_a_trajectory_are_of_like_speed() -> None:
    assert [chosen.all() for chosen in pieces(steady(0.5, "pieces"))] == [True]
    recording = trajectories("pieces")[0]
    parts = list(pieces(recording))
    assert len(parts) > 4
    assert max(np.sum(parts, axis=0)) == 1
    for chosen in parts:
        assert np.ptp(recording.speed[chosen]) <= np.abs(recording.speed).max() / 6 + 1e-12


def test_names_lose_what_they_share() -> None:
    assert short(["ur-20_02_05-20sec", "ur-20_02_06-20sec"]) == ["05-20sec", "06-20sec"]
    assert short(["same", "same"]) == ["same", "same"]
    assert short([]) == []


def test_page_begins_with_the_verdict_and_holds_every_rung_and_run(torque: Judged) -> None:
    said = full(report(torque, None, [LINE]))
    html = page(said, [picture for picture, _ in pictures(torque, None, [LINE], said).values()])
    body = html[html.index("<body>") :]
    assert re.match(r"<body>\s*<h1>([^<]*)</h1>", body).group(1) == said["sentence"]
    assert html.count("data:image/png;base64,") == 6
    rows = re.findall(r"<tr>.*?</tr>", body, flags=re.DOTALL)
    for rung in said["rungs"]:
        row = next(each for each in rows if rung["title"] in each)
        assert f"{rung['heldout']:.3g}" in row
        assert rung["kept"] or rung["why"] in row
    for run in said["runs"]:
        assert any(run["run"] in each and f"{run['after']:.3g}" in each for each in rows), run
    assert "120 Hz" in html
    assert "No question is open" in html


def test_all_text_of_the_page_is_escaped(trajectory: tuple[Judged, Days]) -> None:
    found, by_day = trajectory
    said = full(report(found, by_day, [LINE]))
    said |= {"sentence": NASTY, "robot": NASTY, "joint": NASTY, "defects": [NASTY], "next_experiment": {"words": NASTY}}
    said["split"] = {"fit": [NASTY], "heldout": [NASTY], "left_out": [NASTY]}
    said["unknown"] = {"words": [NASTY], "lines": []}
    said["rungs"] = [{**rung, "title": NASTY, "why": NASTY} for rung in said["rungs"]]
    said["runs"] = [{**run, "run": NASTY, "session": NASTY} for run in said["runs"]]
    html = page(said, [picture for picture, _ in pictures(found, by_day, [], said).values()])
    assert "<script>" not in html
    assert html.count("&lt;script&gt;") > 10


def test_waves_of_a_kind_are_named_together() -> None:
    terms = [Ripple(order=700.0), Ripple(order=8.0), StribeckFriction(), Ripple(order=200.0), Ripple(order=2.0)]
    said = "ripple of 2 and 7 per revolution of the motor, ripple of 2 and 8 per revolution of the output"
    assert listed(terms, 100.0) == f"{said} and Stribeck friction"


def test_the_page_of_all_cases_says_what_each_lacks(torque: Judged, tmp_path: Path) -> None:
    said = full(report(torque, None, []))
    (tmp_path / "ladder.png").write_bytes(b"")
    html = cases_page.page({"a case": said}, {"another": "it is not there"}, {"a case": tmp_path})
    assert f'<td class="text">{said["lacks"]}</td>' in html
    assert said["lacks"] == "ripple of 2 per revolution of the motor"
    assert "another has no answer" in html.lower()


def test_page_says_what_is_not_known(trajectory: tuple[Judged, Days]) -> None:
    found, _ = trajectory
    said = full(report(found, None, [])) | {"days": None, "unknown": None, "next_experiment": None, "gear_ratio": None}
    html = page(said, [])
    assert "No recording at rest" in html
    assert "No line that several recordings share" in html
    assert "None" not in re.sub(r"<p>None[^<]*</p>", "", html)
