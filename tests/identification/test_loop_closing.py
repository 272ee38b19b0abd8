"""What closing the loop makes of what asking says: effects asked again with all the others, and rivals."""

from dataclasses import replace

import numpy as np
import pytest
from fabricated_trials import FITTED, MIMIC, PAIR, A, B, C, Dip, tried
from loop_fixtures import Bump, Wave
from swgsim.identification.decide.accepted import Step, causes, contradicted, with_rivals
from swgsim.identification.decide.candidate import Trial
from swgsim.identification.decide.selection import Closed
from swgsim.identification.decide.selection_step import Round

from swgsim.common.outcome import UNKNOWN
from swgsim.identification.covariance.low_rank_covariance import as_squares
from swgsim.identification.decide import accepted as steps
from swgsim.identification.fit.form_error import FORM_TOLERANCE, Coherence
from swgsim.identification.report import found as effects
from swgsim.identification.report.answer import NOTHING as NOTHING_MISSING
from swgsim.identification.report.answer import Answer, untestable
from swgsim.identification.report.found import why
from swgsim.identification.report.open_questions import unknown
from swgsim.identification.report.sentence import sentence
from swgsim.identification.search.regularities import Atom, Described
from swgsim.identification.search.shortlist import ALPHA

STILL, ANOTHER, NOTHING = Round((A, MIMIC), A, None), Round((MIMIC, A), MIMIC, None), Round((), None, None)
REFUSED, SECOND = Round((MIMIC,), None, None), Round((B,), B, None)


def rivals(other: Trial, chance: float) -> tuple[Trial, ...]:
    """Rivals of an effect, where the other one is as unlikely as this once that is in the model."""
    after = (replace(other.score, chance=chance),)
    step = with_rivals(Step(A, (), (other,)), after, causes([Step(A, (), ())]))
    assert {*step.rivals, *step.others} == {other}
    return step.rivals


@pytest.mark.parametrize(("less", "rival"), [(0.9, True), (1.1, False)])
def test_what_an_imperfect_form_may_cost_does_not_tell_rivals(less, rival):
    other = tried(MIMIC.score.hypothesis, A.evidence * (1 - less * FORM_TOLERANCE**2))
    assert rivals(other, 2 * ALPHA) == ((other,) if rival else ())


@pytest.mark.parametrize(("chance", "agrees"), [(ALPHA / 2, 1.0), (2 * ALPHA, 0.0)])
def test_what_says_more_or_contradicts_itself_is_no_rival(chance, agrees):
    assert rivals(tried(MIMIC.score.hypothesis, agrees=agrees), chance) == ()


def test_the_report_says_beside_what_a_rival_agrees(monkeypatch):
    monkeypatch.setattr(Trial, "deviation", {})
    unknown = Described(Atom(2, "in s1 alone", "constant"), 1.0, 2, 0.1, 0.0)
    assert effects._rival(replace(MIMIC, beside=(unknown,)))["beside"] == [str(unknown)]
    assert effects._rival(MIMIC)["beside"] == []


def test_what_does_not_pay_is_no_rival():
    other = replace(MIMIC, gains=-MIMIC.gains)
    best = replace(A, gains=other.gains)
    assert with_rivals(Step(best, (), (other,)), (replace(other.score, chance=1.0),), frozenset()).rivals == ()
    assert not contradicted(Step(best, (), (replace(other, coherence=(Coherence(0.0, 0.0, 0.0),)),)))


def test_what_is_in_the_model_is_no_rival():
    step, other = Step(A, (), (B,)), Step(B, (), ())
    after = (replace(B.score, chance=2 * ALPHA),)
    assert with_rivals(step, after, causes([step])).rivals == (B,)
    assert with_rivals(step, after, causes([step, other])).rivals == ()


@pytest.mark.parametrize(
    ("other", "more", "both"),
    [(-1.0, 0.2, True), (-1.0, 1.5, True), (-1.0, 2.0, False), (1.0, 0.2, False), (0.0, 1.0, False)],
)
def test_effects_that_cancel_are_no_causes(monkeypatch, other, more, both):
    """A signature and one that is opposite to it, mostly or for a small part, nearly the same, or another thing."""
    rng = np.random.default_rng(3)
    rows, model = len(FITTED.errors.variance), FITTED.model
    one, another = rng.standard_normal((2, rows))
    seen = [one, other * one + more * another]
    now = replace(FITTED, calibrated=replace(FITTED.calibrated, model=model.plus(Bump(1.0), Wave(1.0))))
    monkeypatch.setattr(steps, "signature", lambda _, number: seen[number - len(model.effects)])
    found = Step(A, (), ()), Step(B, (), ())
    assert steps.cancelling(found, now) == (found if both else ())
    pair = (Step(replace(A, effects=(*A.effects, *B.effects)), (), ()),)
    assert steps.cancelling(pair, now) == (pair if both else ())
    assert steps.cancelling(found[:1], now) == ()


@pytest.mark.parametrize(
    ("zeros", "said"),
    [(1.0, "noise, and no effect"), (4.0, "noise, if the bridges were balanced again since commissioning (the zeros")],
)
def test_nothing_is_missing_on_the_condition_under_which_that_holds(zeros, said):
    now = FITTED.with_zeros(zeros)
    found = Closed(now, now, now, (), (), (), (), None)
    assert said in sentence(Answer(NOTHING_MISSING, found, (), (), (), (), ()), ())


@pytest.mark.parametrize("least", [True, False])
def test_what_is_slight_beside_what_it_cancels_is_none_alone(monkeypatch, least):
    rng = np.random.default_rng(3)
    one, another = rng.standard_normal((2, len(FITTED.errors.variance)))
    seen = [one, 0.2 * another - one]
    now = replace(FITTED, calibrated=replace(FITTED.calibrated, model=FITTED.model.plus(Bump(1.0), Wave(1.0))))
    monkeypatch.setattr(steps, "signature", lambda _, number: seen[number - len(FITTED.model.effects)])
    share = FORM_TOLERANCE**2 * (0.9 if least else 1.1)
    found = Step(A, (), ()), Step(replace(B, evidence=share * A.evidence), (), ())
    assert steps.cancelling(found, now) == (found[1:] if least else found)


@pytest.mark.parametrize(
    ("gain", "evidence", "pays"),
    [(50, 1000, True), (9, -1, False), (9, 6, False), (4, 8, True), (2, 8, False), (-2, 11, True), (-4, 1000, False)],
)
def test_an_effect_pays_where_points_left_out_and_all_together_say_so(gain, evidence, pays):
    assert replace(A, gains=np.full(6, gain / 6), evidence=evidence).pays == pays


def test_the_nearest_explains_a_share_of_what_is_left_beyond_noise(monkeypatch):
    rows = len(FITTED.errors.variance)
    left = np.sqrt((rows + 1000.0) / rows) * np.ones(rows)
    monkeypatch.setattr(type(FITTED.whole), "whiten", lambda *_: left)
    monkeypatch.setattr(Trial, "merit", property(lambda trial: trial.evidence))
    monkeypatch.setattr(Trial, "explained", lambda *_: 840.0)
    found = Closed(FITTED, FITTED, FITTED, (), (), (), (A,), None)
    assert found.nearest_explains == pytest.approx(0.84)
    assert Closed(FITTED, FITTED, FITTED, (), (), (), (), None).nearest_explains == 0
    answer = Answer(UNKNOWN, found, (), (), (), (), ())
    assert sentence(answer, ()).endswith(
        "nearest known effect (a bump: height 1) explains 84 % of the remainder and was not accepted."
    )
    assert answer.nearest is A


@pytest.mark.parametrize(("share", "named"), [(0.12, True), (0.08, False), (0.0, False)])
def test_an_effect_that_explains_less_than_a_tenth_is_not_called_the_nearest(share, named):
    closed = Closed(FITTED, FITTED, FITTED, (), (), (), (A,), None)
    vars(closed).update(nearest=A, nearest_explains=share)  # what was computed once
    answer = Answer(UNKNOWN, closed, (), (), (), (), ())
    assert ("nearest known effect" in sentence(answer, ())) == named
    assert (unknown(answer)["nearest"] is not None) == named


@pytest.mark.parametrize(
    ("patterns", "gains", "light"),
    [
        (["the same in s1 to s4"], [11.0], True),
        (["the same in s1 to s4", "the same in s1 to s4"], [5.0, 11.0], True),
        (["the same in s1 to s4", "the same in s1 to s4"], [5.0, 9.0], False),
        (["the same in s1 to s4"], [9.0], False),
        (["in s2 alone"], [1e6], False),
        (["in s2 alone", "in s2 alone", "the same in s1 to s4"], [1e6, 1e6, 9.0], False),
        (["in T_out alone", "in T_in alone"], [1e6, 11.0], True),
        ([], [], False),
    ],
    ids=[
        "much",
        "much beside little",
        "little and what an effect may explain",
        "little",
        "an instrument",
        "an instrument beside little",
        "two channels",
        "nothing",
    ],
)
def test_what_brings_less_than_ten_times_what_is_left_is_no_cause(patterns, gains, light):
    left = [Described(Atom(2, p, "constant"), g, 2, 0.1, 0.0) for p, g in zip(patterns, gains, strict=True)]
    weak, strong = Step(replace(A, evidence=50.0), (), ()), Step(replace(B, evidence=5e9), (), ())
    assert steps.outweighed([weak, strong], left, [replace(A.score, gain=5.0)]) == ((weak,) if light else ())


def test_another_pair_is_a_rival_if_what_only_it_has_says_nothing_more():
    one, other = PAIR, replace(PAIR, effects=(Bump(1.0), Dip(1.0)))
    found = causes([Step(one, (), ())])
    for chance, rival in ((2 * ALPHA, (other,)), (ALPHA / 2, ())):
        after = (replace(C.score, chance=chance),)
        assert with_rivals(Step(one, (), (other,)), after, found).rivals == rival


def test_an_effect_that_was_found_is_none_that_cannot_be_tested():
    scores = (*(replace(each.score, visible=0.0) for each in (A, MIMIC, C)), B.score)
    closed = Closed(FITTED, FITTED, FITTED, (Step(A, (MIMIC,), ()),), scores, (), (), None)
    assert untestable(closed) == scores[2:3]


def test_the_report_says_that_an_effect_shows_by_its_imperfect_form():
    step = Step(replace(A, imperfect=True, coherence=(Coherence(0.5, 0.3, 0.1),)), (), ())
    said = effects._evidence(step, 0)["words"]
    assert "the recordings show it by a deviation of 30 % from that form" in said
    assert "the p-value of its score" not in said
    assert "the p-value of its score" in effects._evidence(Step(A, (), ()), 0)["words"]


def test_it_is_said_why_an_effect_is_no_cause():
    light = replace(A)
    vague = replace(A, coherence=(Coherence(0.5, 0.3, 0.7, 0.66),))
    pair = replace(PAIR, coherence=(Coherence(0.5, 0.0, 0.0), Coherence(0.5, 0.3, 0.7, 0.66)))
    found = Closed(FITTED, FITTED, FITTED, (), (), (), (B, C, light, vague, pair), None, (), (C,), (B,), (light,))
    answer = Answer(UNKNOWN, found, (), (), (), (), ())
    assert why(B, answer) == "it and another effect largely cancel each other: together they imitate another cause"
    assert why(C, answer).startswith("accepted at first")
    assert why(light, answer).startswith("it gains less than ten times the unexplained remainder")
    assert why(vague, answer) == "operating points, channels and orders disagree: its size is uncertain by 66 %"
    assert "the size of wave is uncertain by 66 %" in why(pair, answer)
    foreign = replace(A, own=0.3 * as_squares(A.evidence))
    assert why(foreign, answer).startswith("its library form explains 30 % of its gain;")
