"""The page of a joint and its pictures, on a small simulated joint and on one that reverses."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from joint_fixtures import Hidden, Wave, steady, trajectories
from matplotlib.figure import Figure

from swgsim.common.style import Picture
from swgsim.joint.days import Day, Days, days
from swgsim.joint.effects.friction import StribeckFriction
from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.effects.slip import LoadDependentFriction
from swgsim.joint.figures import pictures
from swgsim.joint.figures.friction import friction
from swgsim.joint.figures.parts import pieces, short
from swgsim.joint.figures.unexplained import unexplained
from swgsim.joint.figures.waves import modelled, ripple_estimates
from swgsim.joint.ladder import Ladder, Trial
from swgsim.joint.naming import listed
from swgsim.joint.pages import page, page_of_cases
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Table, fit
from swgsim.joint.remaining import RemainingLine
from swgsim.joint.report import report
from swgsim.joint.term import Term
from swgsim.joint.textbook import textbook
from swgsim.joint.validation import Validation

ORDER, SIZE, CORNER, DAMPING = 200.0, 0.05, 60.0, 0.4
RIPPLE = Hidden(ripple=(Wave(ORDER, SIZE),), corner=CORNER, damping=DAMPING, stribeck=(0.2, 0.1))
SPEEDS = (-0.6, 0.2, 0.6, 1.0, 1.5)
LINE = RemainingLine(120.0, -300.0, 0.01, 0.6, ("B 0.6",), -0.02)
NASTY = "<script>alert('R&D')</script>"
Drawn = dict[str, tuple[Picture, Figure]]
Torque = tuple[Validation, dict[str, Any], Drawn]
Trajectory = tuple[dict[str, Any], Drawn]


def validation(
    fitted: tuple[JointRecording, ...], held: tuple[JointRecording, ...], of: str, *tried: Term
) -> Validation:
    """A ladder with the first term accepted and the others refused, without the search."""
    table = Table(fitted, of)
    start = fit(table, textbook(table.recordings, of))
    kept = fit(table, (*start.terms, tried[0]))
    step = Trial(kept.terms[-1], kept, 0.5, 0.4, 1e-9)
    added = (fit(table, (*kept.terms, term)) for term in tried[1:])
    refused = tuple(Trial(each.terms[-1], each, 0.001, 0.0, 0.3) for each in added)
    return Validation(Ladder(start, (step,), refused), Table(held, of), 0.01)


RUNS = {s: tuple(steady(v, "page", RIPPLE, s, seconds=2.0) for v in SPEEDS) for s in "AB"}


def full(answer: dict[str, Any]) -> dict[str, Any]:
    """A report as identify_joint completes it."""
    more = {"defects": [], "seconds": 1.0, "noise_floor_how": "of recordings at rest"}
    return {**answer, **more, "date": "2026-01-01", "folder": "logs", "version": "1"}


@pytest.fixture(scope="module")
def torque() -> Torque:
    wave = Ripple(order=ORDER, corner=CORNER, damping=DAMPING)
    found = validation(RUNS["A"], RUNS["B"], "T_sensor", wave, Ripple(order=3.0))
    answer = full(report(found, None, [LINE]))
    return found, answer, pictures(found, None, [LINE], answer)


@pytest.fixture(scope="module")
def trajectory() -> Trajectory:
    recordings = trajectories("page", Hidden(load=0.02), seconds=10.0)
    found = validation(recordings[:3], recordings[3:], "current", LoadDependentFriction(), Ripple(order=101.0))
    by_day = Days(tuple(Day(each.session, 1.0, 0.05, 0.4, 0.03, 3) for each in recordings), 0.3)
    found = replace(found, floor=None)
    answer = full(report(found, by_day, [LINE]))
    return answer, pictures(found, by_day, [], answer)


def html_of(answer: dict[str, Any], drawn: Drawn) -> str:
    return page(answer, {name: picture for name, (picture, _) in drawn.items()})


def empty(figure: Figure) -> list[str]:
    """Panels without data."""
    return [
        axes.get_title(loc="left")
        for axes in figure.get_axes()
        if not any(
            np.isfinite(np.asarray(line.get_ydata(), float)).any() for line in axes.lines if len(line.get_xdata())
        )
    ]


def test_pictures_have_data_named_axes_and_stacked_panels(torque: Torque, trajectory: Trajectory) -> None:
    assert list(torque[2]) == ["ladder", "stretches", "waves"]
    assert list(trajectory[1]) == ["ladder", "stretches", "friction"]
    assert trajectory[1]["stretches"][1].get_axes()[0].get_xlabel() == "time [s]"
    for name, (picture, figure) in [*torque[2].items(), *trajectory[1].items()]:
        assert picture.png.startswith(b"\x89PNG")
        assert picture.caption.endswith(".")
        assert empty(figure) == [], name
        assert len({round(axes.get_position().x0, 2) for axes in figure.get_axes()}) == 1, name
    for name, (_, figure) in torque[2].items():
        named = [axes.get_xlabel() + axes.get_ylabel() for axes in figure.get_axes()]
        assert all("[" in text for text in named), (name, named)


def test_ladder_shows_every_accepted_effect_and_the_noise(torque: Torque) -> None:
    found, answer, drawn = torque
    axes = drawn["ladder"][1].get_axes()[0]
    kept = [rung for rung in answer["rungs"] if rung["kept"]]
    names = [tick.get_text().replace("\n", " ").removeprefix("+ ") for tick in axes.get_yticklabels()]
    assert names == [rung["title"] for rung in kept]
    shown = np.concatenate([np.asarray(line.get_xdata(), float) for line in axes.lines])
    for value in (found.floor, *(rung[which] for rung in kept for which in ("fit", "heldout"))):
        assert np.isclose(shown, value).any()


def test_lines_that_remain_are_drawn_with_their_laws(torque: Torque) -> None:
    """The ripple without a model of it: one line of order 200 in every run."""
    bare = replace(torque[0], ladder=Ladder(torque[0].ladder.textbook, (), ()))
    law = RemainingLine(0.0, ORDER, SIZE, 0.6, ("A 0.6",), 0.1)
    drawn = unexplained(bare, [law])
    assert drawn is not None
    (axes,) = drawn.get_axes()
    speed, frequency = np.asarray(axes.collections[0].get_offsets(), float).T
    np.testing.assert_allclose(np.unique(speed.round(1)), np.unique(np.abs(SPEEDS)))
    assert np.abs(frequency - ORDER * speed / (2 * np.pi)).min() < 0.5
    assert axes.lines[0].get_label() == "order 200 per revolution of the output"
    assert unexplained(torque[0], [LINE]) is None


def test_ripple_is_measured_in_every_run_as_it_was_made(torque: Torque) -> None:
    points = ripple_estimates(torque[0], ORDER)
    assert {point.session for point in points} == {"A", "B"}
    assert {point.heldout for point in points} == {False, True}
    # The response of the second-order filter by its textbook formula; backward runs are mirrored onto it.
    for point in points:
        x = point.frequency / CORNER
        made = SIZE * np.exp(-0.7j) / (1 - x**2 + 2j * DAMPING * x)
        assert abs(point.value - made) < 0.03 * SIZE + 3 * point.noise, point
    omega = np.array([0.2, 1.0])
    x = ORDER * omega / (2 * np.pi) / CORNER
    made = SIZE * np.exp(-0.7j) / (1 - x**2 + 2j * DAMPING * x)
    assert np.allclose(modelled(torque[0], ORDER, omega), made, atol=0.003)


def test_friction_points_lie_on_the_lines_of_their_session() -> None:
    found = validation(RUNS["A"], RUNS["B"], "current", StribeckFriction(v_s=0.1))
    by_day = days(found.ladder.top, (found.table, found.heldout))
    assert by_day is not None
    over, below = friction(found, by_day).get_axes()
    points = [line for line in over.lines if len(line.get_xdata()) == 1]
    assert len(points) == 2 * len(SPEEDS)
    curves = [line for line in over.lines if len(line.get_xdata()) > 1]
    for line in points:
        (v,), (y,) = np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)
        # Stribeck friction adds to the Coulomb friction of slow runs.
        assert min(abs(y - np.interp(v, *curve.get_data())) for curve in curves) < 0.05, v
    assert [tick.get_text() for tick in below.get_xticklabels()] == ["A", "B"]


def test_pieces_are_a_whole_run_or_parts_of_similar_speed_of_a_trajectory() -> None:
    assert [chosen.all() for chosen in pieces(steady(0.5, "pieces"))] == [True]
    recording = trajectories("pieces")[0]
    parts = list(pieces(recording))
    assert len(parts) > 4
    assert max(np.sum(parts, axis=0)) == 1
    for chosen in parts:
        assert np.ptp(recording.speed[chosen]) <= np.abs(recording.speed).max() / 6 + 1e-12


def test_names_are_short_and_waves_of_a_kind_are_named_together() -> None:
    assert short(["ur-20_02_05-20sec", "ur-20_02_06-20sec"]) == ["05-20sec", "06-20sec"]
    assert short(["same", "same"]) == ["same", "same"]
    assert short([]) == []
    terms = [Ripple(order=700.0), Ripple(order=8.0), StribeckFriction(), Ripple(order=200.0), Ripple(order=2.0)]
    both = "ripple of 2 and 7 per revolution of the motor, ripple of 2 and 8 per revolution of the output"
    assert listed(terms, 100.0) == f"{both} and Stribeck friction"


def test_page_begins_with_the_verdict_and_folds_the_details(torque: Torque) -> None:
    _, answer, drawn = torque
    html = html_of(answer, drawn)
    body = html[html.index("<body>") :]
    assert re.match(r"<body>\s*<h1>([^<]*)</h1>", body).group(1) == answer["sentence"]
    front, details = body.split("<details>", 1)
    for text in ("2026-01-01", "logs", "joint", "version 1", "What to do next", "T_rigid", drawn["ladder"][0].title):
        assert text in front
    assert front.count("data:image/png;base64,") == 1
    assert details.count("data:image/png;base64,") == len(drawn) - 1
    rows = re.findall(r"<tr>.*?</tr>", details, flags=re.DOTALL)
    for rung in answer["rungs"]:
        assert any(rung["title"] in row and f"{rung['heldout']:.3g}" in row and rung["why"] in row for row in rows)
    for run in answer["runs"]:
        assert any(run["run"] in row and f"{run['after']:.3g}" in row for row in rows), run
    assert "120 Hz" in details
    # On a narrow screen every wide table scrolls in its own box.
    assert details.count('<div class="wide">') == details.count("<table>")


def test_a_higher_error_on_recordings_not_seen_is_said_plainly() -> None:
    """Stribeck friction on the fitted days, and the opposite on the held-out day."""
    fitted = tuple(steady(v, "here", Hidden(stribeck=(0.07, 0.15)), "A", rate=100.0) for v in (0.05, 0.1, 0.3, 0.8))
    held = tuple(steady(v, "there", Hidden(stribeck=(-0.07, 0.15)), "B", rate=100.0) for v in (0.05, 0.1, 0.3, 0.8))
    found = validation(fitted, held, "current", StribeckFriction(v_s=0.15))
    answer = full(report(found, None, []))
    assert answer["verdict"] == "not_confirmed"
    before, after = (answer["error"][when]["heldout"] for when in ("before", "after"))
    assert after > before
    plain = "Stribeck friction fits the recordings of A, but the recordings that judge contradict it"
    assert plain in answer["sentence"]
    assert f"the error on recordings not seen rises from {before:.3g} to {after:.3g} A" in answer["sentence"]
    assert (answer["lacks"], answer["contradicted"]) == ("", "Stribeck friction")
    assert answer["rungs"][1]["why"] == "contradicted: raises the error on held-out recordings"
    assert page(answer, {}).count("contradicted: raises") == 1
    assert "Do not use the effects found" in page(answer, {})
    reversed_ = full(report(validation(held, held, "current", StribeckFriction(v_s=0.15)), None, []))
    assert reversed_["verdict"] == "effect_found"
    assert "falls from" in reversed_["sentence"]


def test_parameters_have_names_and_units_and_limits_are_cautions(torque: Torque, trajectory: Trajectory) -> None:
    units = {name: each["unit"] for name, each in torque[1]["calibrated"].items()}
    assert units == {"inertia": "N m s^2/rad", "gravity cosine": "N m", "gravity sine": "N m"}
    units = {name: each["unit"] for name, each in trajectory[0]["calibrated"].items()}
    assert units == {
        "factor of the rigid-body torque": "A/(N m)", "Coulomb friction": "A", "viscous friction": "A s/rad",
        "zero": "A",
    }  # fmt: skip
    assert any("gravity of a single link" in caution for caution in torque[1]["cautions"])
    assert trajectory[0]["cautions"] == []


def test_all_text_of_the_page_is_escaped(trajectory: Trajectory) -> None:
    answer, drawn = trajectory
    answer = answer | {"next_experiment": {"words": NASTY}, "unknown": {"words": [NASTY], "lines": []}}
    answer |= dict.fromkeys(("sentence", "robot", "joint", "folder"), NASTY)
    answer |= {name: [NASTY] for name in ("defects", "cautions")}
    answer["split"] = {"fit": [NASTY], "heldout": [NASTY], "left_out": [NASTY]}
    answer["rungs"] = [{**rung, "title": NASTY, "why": NASTY} for rung in answer["rungs"]]
    answer["runs"] = [{**run, "run": NASTY, "session": NASTY} for run in answer["runs"]]
    html = html_of(answer, drawn)
    assert "<script>" not in html
    assert html.count("&lt;script&gt;") > 10


def test_page_without_noise_or_remaining_lines(trajectory: Trajectory) -> None:
    html = page(trajectory[0] | {"days": None, "unknown": None, "next_experiment": None, "gear_ratio": None}, {})
    for text in ("No recording at rest", "no line that several recordings share", "No question is open"):
        assert text in html
    assert "None" not in html.replace("<li>None.</li>", "")


def test_the_page_of_all_cases_names_missing_effects(torque: Torque, tmp_path: Path) -> None:
    (tmp_path / "ladder.png").write_bytes(b"")
    html = page_of_cases({"a case": torque[1]}, {"another": "it does not exist"}, {"a case": tmp_path})
    assert '<td class="text">ripple of 2 per revolution of the motor</td>' in html
    assert "another has no answer" in html.lower()
