"""What closing the loop makes of what asking says: effects asked again with all the others, and rivals."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from fabricated_trials import FITTED, MIMIC, PAIR, A, B, C, Dip, Mimic, tried
from loop_fixtures import BUMP, Bump, Wave

from swgsim.common.outcome import UNKNOWN
from swgsim.identification.covariance.low_rank_covariance import as_squares
from swgsim.identification.data.model import Model
from swgsim.identification.decide import accepted as steps
from swgsim.identification.decide import selection as closed
from swgsim.identification.decide import selection_step as asking
from swgsim.identification.decide import stepwise_selection as closing
from swgsim.identification.decide.accepted import Step, causes, contradicted, with_rivals
from swgsim.identification.decide.candidate import Trial
from swgsim.identification.decide.selection import Closed
from swgsim.identification.decide.selection_step import Round
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.form_error import FORM_TOLERANCE, Coherence
from swgsim.identification.report import found as effects
from swgsim.identification.report.answer import NOTHING as NOTHING_MISSING
from swgsim.identification.report.answer import Answer, untestable
from swgsim.identification.report.found import why
from swgsim.identification.report.open_questions import unknown
from swgsim.identification.search.regularities import Atom, Described
from swgsim.identification.search.shortlist import ALPHA, screened


def kinds(steps: tuple[Step, ...]) -> tuple[type, ...]:
    return tuple(type(effect) for step in steps for effect in step.accepted.effects)


def backward(monkeypatch, said: Sequence[Round], *first: Trial) -> tuple[tuple[type, ...], list[tuple[type, ...]]]:
    """Effects after the backward pass, and beside which others each was asked."""
    beside, answers = [], iter(said)

    def joined(base, steps):
        beside.append(kinds(tuple(steps)))
        return base

    monkeypatch.setattr(closing, "joined", joined)
    monkeypatch.setattr(closing, "screened", lambda *_: ())
    monkeypatch.setattr(closing, "ask", lambda *_: next(answers))
    kept = closing._backward(FITTED, tuple(Step(trial, (), ()) for trial in first), (), (), 0)
    assert next(answers, None) is None
    return kinds(kept), beside


STILL, ANOTHER, NOTHING = Round((A, MIMIC), A, None), Round((MIMIC, A), MIMIC, None), Round((), None, None)
REFUSED, SECOND = Round((MIMIC,), None, None), Round((B,), B, None)


@pytest.mark.parametrize(
    ("said", "left", "beside"),
    [
        ([STILL], (Bump, Wave), [(Wave,)]),
        ([ANOTHER, SECOND], (Mimic, Wave), [(Wave,), (Mimic,)]),
        ([ANOTHER, NOTHING], (Mimic,), [(Wave,), (Mimic,)]),
        ([NOTHING], (Wave,), [(Wave,)]),
        ([REFUSED], (Bump, Wave), [(Wave,)]),
        ([SECOND], (Bump, Wave), [(Wave,)]),
    ],
    ids=[
        "still the best", "another was meant", "and the second only mended the first",
        "nothing stands out any more", "what stands out is not accepted", "the other one once more",
    ],
)  # fmt: skip
def test_each_effect_is_asked_again_until_it_was_asked_beside_the_others_that_are_left(monkeypatch, said, left, beside):
    assert backward(monkeypatch, said, A, B) == (left, beside)


def test_three_effects(monkeypatch):
    assert backward(monkeypatch, [STILL, SECOND], A, B, C) == ((Bump, Wave, Dip), [(Wave, Dip), (Bump, Dip)])
    assert backward(monkeypatch, [STILL, NOTHING], A, B, C) == ((Bump, Dip), [(Wave, Dip), (Bump, Dip)])


def test_what_was_found_in_an_imperfect_form_is_not_asked_again_in_its_own(monkeypatch):
    assert backward(monkeypatch, [], replace(A, imperfect=True), B) == ((Bump, Wave), [])


def test_a_pair_is_not_halved(monkeypatch):
    pair = replace(A, effects=(*A.effects, *B.effects))
    assert backward(monkeypatch, [STILL], pair, C) == ((Bump, Wave, Dip), [(Dip,)])


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


@pytest.mark.parametrize("agrees", [True, False])
def test_what_is_unknown_does_not_speak_against_rivals_alone(monkeypatch, agrees):
    """An effect that is as good contradicts itself only by what the accepted one leaves unknown too."""
    other = tried(MIMIC.score.hypothesis, agrees=0.0)
    unknown = (Described(Atom(2, "in s1 alone", "constant"), 1.0, 2, 0.1, 0.0),)
    agreeing = replace(other, coherence=MIMIC.coherence, beside=unknown)
    monkeypatch.setattr(steps, "beside_unknown", lambda trial, left: agreeing if agrees and left == unknown else None)
    step, after = Step(A, (), (other,)), (replace(other.score, chance=2 * ALPHA),)
    assert contradicted(step)
    assert not contradicted(Step(A, (), (MIMIC,)))
    found = with_rivals(step, after, causes([step]), unknown)
    assert (found.rivals, found.others) == (((agreeing,), ()) if agrees else ((), (other,)))


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


@pytest.mark.parametrize("contradiction", [True, False])
def test_what_is_left_unknown_is_asked_for_where_it_may_speak_against_a_rival(monkeypatch, contradiction):
    """And rivals are sought beside it."""
    step = Step(A, (), (tried(MIMIC.score.hypothesis, agrees=0.0 if contradiction else 1.0),))
    given = []
    monkeypatch.setattr(closing, "fit", lambda *_: FITTED)
    monkeypatch.setattr(
        closing, "_forward", lambda *_: closing.End(FITTED, (step,), (), ((), ()), Round((), None, None))
    )
    left = tuple(Described(Atom(order, "in s1 alone", "constant"), 20.0, 2, 0.1, 0.0) for order in (3, 5))
    monkeypatch.setattr(closing, "regularities", lambda now, seed: left if (now, seed) == (FITTED, 7) else ())
    monkeypatch.setattr(closing, "with_rivals", lambda step, after, found, unknown: given.append(unknown) or step)
    found = closing.close(FITTED.measured, FITTED.unit, (), seed=7)
    assert given == ([left[:1]] if contradiction else [()])
    assert found.unknown == left


def test_an_effect_that_leaves_much_is_put_off_and_what_is_left_without_it_is_described(monkeypatch):
    step, bare = Step(A, (), ()), replace(FITTED)
    much = Described(Atom(4, "the same in s1 to s4", "constant"), 1e9, 2, 0.1, 0.0)
    more = replace(much, gain=2e9)
    monkeypatch.setattr(closing, "fit", lambda *_: bare)
    monkeypatch.setattr(
        closing, "_forward", lambda *_: closing.End(FITTED, (step,), (), ((), ()), Round((), None, None))
    )
    monkeypatch.setattr(closing, "screened", lambda *_: ())
    monkeypatch.setattr(closing, "regularities", lambda now, *_: (more,) if now is bare else (much,))
    found = closing.close(FITTED.measured, FITTED.unit, ())
    assert (found.steps, found.outweighed, found.unknown, found.withdrawn) == ((), (A,), (more,), ())
    assert found.rejected == (A,)
    assert found.asked is bare


@pytest.mark.parametrize(("settled", "left"), [(True, True), (False, True), (True, False)])
def test_all_that_was_found_is_fitted_once_more_in_its_own_form(monkeypatch, settled, left):
    """Beside what was set apart, unless that comes to no rest or leaves nothing of one; a lone effect was so before."""
    rows = len(FITTED.errors.variance)
    opened = FITTED.allowing(np.ones((rows, 3)))
    disturbance = Described(Atom(2, "in s1 alone", "constant"), 1.0, 2, 0.1, 0.0)
    given = []

    def extended(now, added):
        given.append((now.allowed.columns.shape[1], added))
        model = replace(now.model, effects=(*now.model.effects, Bump(1.0)))
        return replace(now, calibrated=replace(now.calibrated, model=model, settled=settled))

    monkeypatch.setattr(closing, "extended", extended)
    monkeypatch.setattr(closing, "signature", lambda now, number: np.zeros(rows))
    monkeypatch.setattr(closing, "seen", lambda now, signatures: left)
    end = closing.End(opened, (Step(A, (), ()), Step(B, (), ())), (disturbance,), (), Round((), None, None))
    found = closing._together(end)
    assert given == [(2, ())]
    assert (found.calibrated is FITTED.calibrated) == (not (settled and left))
    assert not found.allowed.columns.shape[1]
    assert found.open.shape == FITTED.open.shape
    closing._together(end._replace(steps=end.steps[:1]))
    assert len(given) == 1
    # Its form was open when it was fitted.
    closing._together(end._replace(steps=(Step(replace(A, imperfect=True), (), ()),)))
    assert len(given) == 2


def test_how_well_parts_agree_is_asked_with_all_effects_in_the_model(monkeypatch):
    """An imperfect form of one leaves the size of the other in doubt."""
    declared = replace(FITTED, calibrated=replace(FITTED.calibrated, model=Model(GEAR, (Wave(1.0),))))
    disturbance = Described(Atom(2, "in s1 alone", "constant"), 1.0, 2, 0.1, 0.0)
    found, free = {1: Coherence(1.0, 0.1, 0.3), 2: Coherence(1.0, 0.2, 0.0)}, []

    def coherence(now, number):
        free.append(now.allowed.columns.shape[1])
        return found[number]

    def doubt(now, number, others):
        free.append(now.allowed.columns.shape[1])
        (other,) = others
        assert {number, other} == {1, 2}
        return 2 * others[other].form_error

    monkeypatch.setattr(closed, "coherence", coherence)
    monkeypatch.setattr(closed, "doubt_by_others", doubt)
    first, second = Step(replace(A, beside=(disturbance,)), (), ()), Step(B, (), ())
    now = Closed(declared, declared, declared, (first, second), (), (), (), None, (disturbance,))
    assert [each.doubt for each in now.coherence] == pytest.approx([0.5, 0.2])
    assert free == [4, 2, 2, 2]

    def widened(now, first, each):
        return {"free": now.allowed.columns.shape[1], "first": first, "of": len(each)}

    monkeypatch.setattr(closed, "widened", widened)
    assert now.deviation == {"free": 2, "first": 1, "of": 2}


def test_what_is_in_the_model_is_no_rival():
    step, other = Step(A, (), (B,)), Step(B, (), ())
    after = (replace(B.score, chance=2 * ALPHA),)
    assert with_rivals(step, after, causes([step])).rivals == (B,)
    assert with_rivals(step, after, causes([step, other])).rivals == ()


@pytest.mark.parametrize(
    ("outdone", "pair", "accepted"),
    [((), PAIR, A), ((A,), PAIR, PAIR), ((A, PAIR), PAIR, None), ((A,), None, None)],
    ids=["not outdone", "two effects", "the two are outdone as well", "no two are sound"],
)
def test_what_a_regularity_tells_beyond_an_effect_may_be_a_second_one(monkeypatch, outdone, pair, accepted):
    plain = Described(Atom(2, "in s1 alone", "constant"), 2000.0, 2, 0.1, 0.0)
    declared = replace(FITTED)
    monkeypatch.setattr(asking, "unbent", lambda now: declared if now is FITTED else now)
    monkeypatch.setattr(asking, "zoom", lambda _, start: Bump(1.0) if start is declared else None)
    monkeypatch.setattr(asking, "tried", lambda now, _, added, start: {FITTED: A}[now] if start is declared else None)
    monkeypatch.setattr(asking, "paired", lambda *_: (pair,) if pair else ())
    monkeypatch.setattr(asking, "worth_it", lambda pairs, *_: next(iter(pairs), None))
    monkeypatch.setattr(asking, "describe", lambda _: (plain,))
    monkeypatch.setattr(asking, "outdone", lambda trial, *_: any(trial is each for each in outdone))
    found = asking.ask(FITTED, [A.score], [], 0)
    assert found.accepted is accepted
    assert found.outdone_by == (None if accepted else plain)


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


def test_two_forms_of_one_kind_that_cancel_are_that_kind(monkeypatch):
    rng = np.random.default_rng(3)
    one, another = rng.standard_normal((2, len(FITTED.errors.variance)))
    seen = [one, 0.2 * another - one]
    now = replace(FITTED, calibrated=replace(FITTED.calibrated, model=FITTED.model.plus(Bump(1.0), Bump(2.0))))
    monkeypatch.setattr(steps, "signature", lambda _, number: seen[number - len(FITTED.model.effects)])
    assert steps.cancelling((Step(A, (), ()), Step(replace(A, effects=(Bump(2.0),)), (), ())), now) == ()


def test_where_no_effect_explains_zeros_that_moved_bridges_were_balanced_anew(monkeypatch):
    """The same is asked once more, and whatever follows begins there."""
    wide, seen = FITTED.with_zeros(4.0), []
    monkeypatch.setattr(Fitted, "balanced", property(lambda now: now if now.measured.zeros > 1 else wide))
    monkeypatch.setattr(closing, "fit", lambda *_: FITTED)
    monkeypatch.setattr(closing, "screened", lambda *_: ())
    monkeypatch.setattr(closing, "regularities", lambda *_: ())
    monkeypatch.setattr(closing, "ask", lambda now, *_: seen.append(now.measured.zeros) or Round((), None, None))
    found = closing.close(FITTED.measured, FITTED.unit, ())
    assert seen == [1.0, 4.0]
    assert found.before.measured.zeros == found.asked.measured.zeros == 4.0


@pytest.mark.parametrize(
    ("zeros", "said"),
    [(1.0, "noise, and no effect"), (4.0, "noise, if bridges were balanced anew (zeros of gauges lie up to 4 times")],
)
def test_nothing_is_missing_on_the_condition_under_which_that_holds(zeros, said):
    now = FITTED.with_zeros(zeros)
    found = Closed(now, now, now, (), (), (), (), None)
    assert said in Answer(NOTHING_MISSING, found, (), (), (), (), ()).sentence


def test_what_a_disturbance_hides_is_sought_before_bridges_count_as_balanced_anew(monkeypatch):
    wide, disturbed = FITTED.with_zeros(4.0), Round((A,), None, None)
    monkeypatch.setattr(Fitted, "balanced", property(lambda now: now if now.measured.zeros > 1 else wide))
    monkeypatch.setattr(Trial, "with_open_form", property(lambda _: wide))
    monkeypatch.setattr(closing, "screened", lambda *_: ())
    monkeypatch.setattr(closing, "ask", lambda *_: disturbed)
    monkeypatch.setattr(
        closing, "ask_behind", lambda now, found, *_: (Round((A,), A, None) if now is FITTED else found, ())
    )
    found = closing._forward(FITTED, (), (), (), 0)
    assert [step.accepted for step in found.steps] == [A]


@pytest.mark.parametrize(("order", "moved", "asked"), [(0, True, False), (0, False, True), (5, True, True)])
def test_a_zero_that_balancing_explains_is_not_set_apart(monkeypatch, order, moved, asked):
    wide, behind = FITTED.with_zeros(4.0), []
    plain = Described(Atom(order, "in s1 alone", "constant"), 400.0, 1, 0.1, 0.0, 0.0)
    monkeypatch.setattr(Fitted, "balanced", property(lambda now: wide if moved else now))
    monkeypatch.setattr(asking, "strongest", lambda *_: plain)
    monkeypatch.setattr(asking, "freed", lambda now, _: now)
    monkeypatch.setattr(asking, "screened", lambda *_: ())
    monkeypatch.setattr(asking, "ask", lambda *_: behind.append(1) or Round((A,), A, None))
    found, apart = asking.ask_behind(FITTED, Round((A,), None, None), (), 0, 0, ())
    assert (bool(behind), found.accepted, apart) == ((True, A, (plain,)) if asked else (False, None, ()))


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


def test_effects_that_are_no_likelier_than_nothing_are_luck(monkeypatch):
    lucky = [replace(each, gains=np.full(6, 1.5), evidence=-1.0) for each in (A, B)]
    monkeypatch.setattr(asking, "unbent", lambda now: now)
    monkeypatch.setattr(asking, "zoom", lambda *_: Bump(1.0))
    monkeypatch.setattr(asking, "tried", lambda *_: trials.pop())
    trials = list(lucky)
    assert asking.ask(FITTED, [A.score, B.score], [], 0) == asking.Round((), None, None)


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
    assert answer.sentence.endswith("effect, bump (height 1), explains 84 % of it and was not accepted.")
    assert answer.nearest is A


@pytest.mark.parametrize(("share", "named"), [(0.12, True), (0.08, False), (0.0, False)])
def test_an_effect_that_explains_less_than_a_tenth_is_not_called_the_nearest(share, named):
    closed = Closed(FITTED, FITTED, FITTED, (), (), (), (A,), None)
    vars(closed).update(nearest=A, nearest_explains=share)  # what was computed once
    answer = Answer(UNKNOWN, closed, (), (), (), (), ())
    assert ("nearest known effect" in answer.sentence) == named
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


def test_nothing_is_outweighed_by_nothing():
    assert steps.outweighed([Step(replace(A, evidence=-1.0), (), ())], [], []) == ()


@pytest.mark.parametrize(("steps", "untried"), [(1, ["Bump"]), (3, ["Bump", "Wave"])])
def test_effects_that_do_not_stand_out_are_untried_and_all_once_enough_were_added(steps, untried):
    scores = (replace(A.score, chance=2 * ALPHA), replace(B.score, chance=ALPHA / 2))
    end = closing.End(FITTED, (Step(A, (), ()),) * steps, (), (scores,), Round((), None, None))
    assert [score.hypothesis.kind.__name__ for score in closing._untried(end)] == untried


def test_another_pair_is_a_rival_if_what_only_it_has_says_nothing_more():
    one, other = PAIR, replace(PAIR, effects=(Bump(1.0), Dip(1.0)))
    found = causes([Step(one, (), ())])
    for chance, rival in ((2 * ALPHA, (other,)), (ALPHA / 2, ())):
        after = (replace(C.score, chance=chance),)
        assert with_rivals(Step(one, (), (other,)), after, found).rivals == rival


@pytest.mark.parametrize(
    ("steps", "balanced", "where"),
    [((), True, "as it is"), ((), False, "balanced"), ((Step(B, (), ()),), True, "nowhere")],
    ids=["nothing was found", "zeros have moved", "an effect was found"],
)
def test_an_imperfect_form_is_asked_for_where_nothing_was_found_in_its_own(monkeypatch, steps, balanced, where):
    """And it is settled where the zeros lie."""
    refused, asked, anew = Round((MIMIC,), None, None), [], replace(FITTED)
    monkeypatch.setattr(Fitted, "balanced", property(lambda now: now if balanced or now is not FITTED else anew))
    monkeypatch.setattr(Trial, "with_open_form", anew)
    monkeypatch.setattr(closing, "screened", lambda *_: (A.score,))
    monkeypatch.setattr(closing, "ask", lambda *_: refused)
    monkeypatch.setattr(closing, "ask_behind", lambda now, found, *_: (found, ()))
    monkeypatch.setattr(closing, "ask_imperfect", lambda now, *_: asked.append(now) or Round((A, MIMIC), A, None))
    end = closing._forward(FITTED, steps, (), (), 0)
    assert asked == {"as it is": [FITTED], "balanced": [anew], "nowhere": []}[where]
    assert [each.accepted for each in end.steps] == [*(each.accepted for each in steps), *([A] if asked else [])]
    assert end.last is refused


def test_an_effect_that_was_found_is_none_that_cannot_be_tested():
    scores = (*(replace(each.score, visible=0.0) for each in (A, MIMIC, C)), B.score)
    closed = Closed(FITTED, FITTED, FITTED, (Step(A, (MIMIC,), ()),), scores, (), (), None)
    assert untestable(closed) == scores[2:3]


def test_the_report_says_that_an_effect_shows_by_its_imperfect_form():
    step = Step(replace(A, imperfect=True, coherence=(Coherence(0.5, 0.3, 0.1),)), (), ())
    said = effects._evidence(step, 0)["words"]
    assert "it shows by how it differs from that form, by 30 %" in said
    assert "comes by luck" not in said
    assert "comes by luck" in effects._evidence(Step(A, (), ()), 0)["words"]


@pytest.mark.parametrize("settled", [True, False])
def test_without_effects_that_cancel_the_others_stay_if_they_come_to_rest(monkeypatch, settled):
    still = replace(FITTED, calibrated=replace(FITTED.calibrated, settled=settled))
    monkeypatch.setattr(Trial, "merit", property(lambda trial: trial.evidence))
    monkeypatch.setattr(closing, "joined", lambda base, kept: still)
    monkeypatch.setattr(closing, "screened", lambda *_: ())
    found, better = [Step(each, (), (MIMIC,)) for each in (A, B, C)], replace(B, evidence=2000.0)
    found[1] = Step(better, (), ())
    before = closing.End(FITTED, tuple(found), (), (), Round((), None, None))
    end = closing._without(found[:2], before, FITTED, (), 0)
    assert end.steps == (tuple(found[2:]) if settled else ())
    assert end.now is (still if settled else FITTED)
    assert end.last == Round((better, A, MIMIC), None, None)


def test_what_was_added_is_not_screened_again():
    added = replace(FITTED, calibrated=replace(FITTED.calibrated, model=FITTED.model.plus(Bump(1.0))))
    assert screened(added, [Bump], np.random.default_rng(1)) == ()


@pytest.mark.parametrize(("accepted", "listed"), [("pair", True), ("single", False)])
def test_other_pairs_may_be_rivals_of_a_pair_alone(monkeypatch, accepted, listed):
    best = A if accepted == "single" else tried(BUMP, agrees=0.0)
    other, doubles = (replace(PAIR, effects=(first(1.0), Dip(1.0))) for first in (Bump, Mimic))
    monkeypatch.setattr(asking, "unbent", lambda now: now)
    monkeypatch.setattr(asking, "zoom", lambda *_: Bump(1.0))
    monkeypatch.setattr(asking, "tried", lambda *_: best)
    monkeypatch.setattr(asking, "paired", lambda *_: (PAIR, other))
    monkeypatch.setattr(asking, "worth_it", lambda pairs, *_: pairs[0])
    monkeypatch.setattr(asking, "of_doubles", lambda accepted, *_: (doubles,) if accepted is PAIR else ())
    monkeypatch.setattr(
        asking, "describe", lambda _: (Described(Atom(2, "in s1 alone", "constant"), 1.0, 2, 0.1, 1.0),)
    )
    monkeypatch.setattr(asking, "outdone", lambda *_: False)
    found = asking.ask(FITTED, [A.score], [], 0)
    assert found.accepted is (PAIR if listed else A)
    assert found.trials == ((best, PAIR, other, doubles) if listed else (best,))


def test_it_is_said_why_an_effect_is_no_cause():
    light = replace(A)
    vague = replace(A, coherence=(Coherence(0.5, 0.3, 0.7, 0.66),))
    pair = replace(PAIR, coherence=(Coherence(0.5, 0.0, 0.0), Coherence(0.5, 0.3, 0.7, 0.66)))
    found = Closed(FITTED, FITTED, FITTED, (), (), (), (B, C, light, vague, pair), None, (), (C,), (B,), (light,))
    answer = Answer(UNKNOWN, found, (), (), (), (), ())
    assert why(B, answer) == "it and another one cancel much of one another: together they imitate something else"
    assert why(C, answer).startswith("accepted at first")
    assert why(light, answer).startswith("it brings less than ten times what it leaves")
    assert why(vague, answer) == "operating points, channels and orders leave its size in doubt by 66 %"
    assert "leave the size of wave in doubt by 66 %" in why(pair, answer)
    foreign = replace(A, own=0.3 * as_squares(A.evidence))
    assert why(foreign, answer).startswith("as the library has it, it explains 30 % of what it gains;")
