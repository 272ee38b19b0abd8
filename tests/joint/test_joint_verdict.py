"""Verdict and sentence of a joint follow its numbers, whatever they are."""

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from joint_fixtures import PER_TORQUE, coloured, trajectory

from swgsim.common.seeds import generator
from swgsim.joint.effects.friction import AsymmetricFriction, QuadraticFriction, StribeckFriction
from swgsim.joint.effects.load import LoadCurve
from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.ladder import Ladder, Trial, forward_selection
from swgsim.joint.pages import page
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Fit, Table, fit
from swgsim.joint.report import report
from swgsim.joint.term import Term
from swgsim.joint.textbook import textbook
from swgsim.joint.validation import Validation
from swgsim.joint.verdict import LEAST_EXPLAINED, percent

EFFECTS = (StribeckFriction(), AsymmetricFriction(), QuadraticFriction(), LoadCurve(), Ripple(order=101.0))
TABLES = [Table((trajectory(number, "verdict", rate=20.0),), "current") for number in range(2)]
FITTED = [fit(TABLES[0], (*textbook(TABLES[0].recordings, "current"), *EFFECTS[:n])) for n in range(len(EFFECTS) + 1)]


def disturbed(found: Fit, by: float, seed: int) -> Fit:
    """A model with other weights: it may be any amount better or worse on other recordings."""
    off = generator("verdict", seed).normal(size=len(found.weights)) * by
    ends = np.cumsum([len(term.weights) for term in found.terms])[:-1]
    terms = (t.weighted(w) for t, w in zip(found.terms, np.split(found.weights * (1 + off), ends), strict=True))
    return Fit(found.table, tuple(terms), found.X)


def fabricated(sizes: list[float], seed: int) -> Validation:
    """Accepted effects, of models that are off by some relative size each."""
    fits = [disturbed(found, by, seed) for found, by in zip(FITTED, sizes, strict=False)]
    steps = tuple(Trial(each.terms[-1], each, 0.1, 0.1, 1e-3) for each in fits[1:])
    return Validation(Ladder(fits[0], steps, ()), TABLES[1], None)


@settings(max_examples=25, deadline=None)
@given(
    sizes=st.lists(st.sampled_from([0.0, 0.01, 0.1, 0.5, 3.0]), min_size=1, max_size=len(FITTED)),
    seed=st.integers(0, 10**6),
)
def test_no_sentence_contradicts_its_numbers(sizes: list[float], seed: int) -> None:
    validation = fabricated(sizes, seed)
    said = report(validation, None, [])
    text, kept = said["sentence"], [rung for rung in said["rungs"] if rung["kept"]]
    before, after = (said["error"][when]["heldout"] for when in ("before", "after"))
    change = re.search(r"(falls|rises) from (\S+) to (\S+) A", text)
    if change:
        assert (change[1] == "falls") == (after < before) == (float(change[3]) < float(change[2]))
    assert ("stays at" in text) <= (after == before)
    assert ("contradict" in text) <= (after > before)
    assert ("textbook model lacks" in text) == (said["verdict"] == "effect_found")
    assert (said["verdict"] == "effect_found") <= (after < before)
    assert (said["verdict"] == "nothing_missing") <= (not said["effects"] and said["textbook_explains_ci95"][1] > 0)
    assert bool(said["likely"]) == (said["verdict"] == "textbook_fails")
    lacks = text.partition("lacks")[2].partition(";")[0]
    for last, rung in pairwise(kept):
        assert rung["contradicted"] == (rung["heldout"] > last["heldout"]) == ("contradicted" in rung["why"])
        name = rung["title"].split(" of order")[0]
        assert (name in said["contradicted"]) == rung["contradicted"]
        if lacks:
            assert (name in lacks) != rung["contradicted"]
            assert not rung["contradicted"] or "raise" in text
    variance = float(np.var(validation.heldout.signal))
    assert np.isclose(said["textbook_explains"], 1 - before**2 / variance)
    assert said["explains"].startswith(percent(said["textbook_explains"]))
    html = page(
        {**said, "defects": [], "seconds": 1.0, "noise_floor_how": "", "date": "", "folder": "", "version": ""}, {}
    )
    assert html.count("contradicted: raises") == sum(rung["contradicted"] for rung in kept)
    assert said["explains"].split(" of ")[0] in html


def test_the_page_begins_with_the_share_and_marks_each_contradicted_effect() -> None:
    said = report(fabricated([0.0, 3.0, 0.0, 3.0], 1), None, [])
    more = dict.fromkeys(("noise_floor_how", "date", "folder", "version"), "")
    html = page({**said, **more, "defects": [], "seconds": 1.0}, {})
    contradicted = sum(rung["contradicted"] for rung in said["rungs"])
    assert html.count("contradicted: raises") == html.count('<tr class="against">') == contradicted > 0
    lead = html[html.index('class="lead"') :]
    assert lead.index(said["explains"]) < lead.index("<table>")


def noise_alone(number: int) -> JointRecording:
    """A joint whose model torque was mapped wrongly: the signal has nothing to do with it."""
    here = trajectory(number, "noise", rate=50.0)
    other = trajectory(number + 10, "noise", rate=50.0)
    return JointRecording(
        here.name, "robot", "joint", here.session, here.time,
        {**here.signals, "current": other.signals["current"]}, gear_ratio=101.0,
    )  # fmt: skip


def answer(recordings: tuple[JointRecording, ...], of: str, kinds: tuple[type[Term], ...] = ()) -> dict:
    found = Validation(forward_selection(Table(recordings[:-1], of), kinds), Table(recordings[-1:], of), None)
    return report(found, None, [])


def test_a_textbook_that_explains_nothing_is_told_with_likely_causes() -> None:
    said = answer(tuple(map(noise_alone, range(4))), "current")
    assert said["verdict"] == "textbook_fails"
    assert said["textbook_explains"] < 0.5
    assert "does not describe these recordings" in said["sentence"]
    assert any("side of the gear" in cause for cause in said["likely"])
    assert "check" in said["next_experiment"]["words"]


def test_friction_that_would_have_to_drive_is_a_failure_of_the_textbook() -> None:
    """The load explains most of the current, whose sign is the opposite one."""
    recordings = (trajectory(number, "inverted", weight=80.0, rate=50.0) for number in range(3))
    said = answer(
        tuple(replace(each, signals={**each.signals, "current": -each.signals["current"]}) for each in recordings),
        "current",
    )
    assert said["verdict"] == "textbook_fails"
    assert said["textbook_explains"] > LEAST_EXPLAINED
    assert "Coulomb friction" in said["likely"][0]
    assert "inverted: true" in said["likely"][0]


def test_the_torque_of_a_motor_that_is_mapped_as_a_torque_sensor_is_told() -> None:
    recordings = []
    for number in range(3):
        here = trajectory(number, "motor", rate=50.0)
        of_motor = here.signals["current"] / PER_TORQUE
        signals = {"q": here.signals["q"], "omega": here.signals["omega"], "T_sensor": of_motor}
        recordings.append(replace(here, signals=signals))
    said = answer(tuple(recordings), "T_sensor")
    assert said["verdict"] == "textbook_fails"
    assert "map it as T_motor" in said["likely"][0]


def test_a_signal_of_noise_alone_is_no_failure_of_the_textbook() -> None:
    """A level joint without friction whose sensor shows its noise: there is nothing to explain."""
    recordings = []
    for number in range(3):
        here = trajectory(number, "quiet", weight=0.0, rate=50.0)
        noise = coloured(generator("quiet", number), len(here), 50.0, 0.01)
        signals = {"q": here.signals["q"], "omega": here.signals["omega"], "T_sensor": noise}
        recordings.append(JointRecording(here.name, "robot", "joint", here.session, here.time, signals))
    assert answer(tuple(recordings), "T_sensor")["verdict"] == "nothing_missing"


def test_errors_within_and_beyond_the_fitted_speeds_make_up_the_whole() -> None:
    slow, fast = trajectory(0, "slow", rate=20.0, seconds=50.0), trajectory(1, "fast", rate=20.0)
    found = Validation(forward_selection(Table((slow,), "current"), ()), Table((fast,), "current"), None)
    speeds = report(found, None, [])["speeds"]
    share = speeds["share_beyond"]
    assert 0 < share < 1
    squares = [speeds[where]["after"] ** 2 for where in ("within", "beyond")]
    assert np.isclose((1 - share) * squares[0] + share * squares[1], found.after.heldout**2)
