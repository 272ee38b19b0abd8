"""Which pairs of effects are tried, and which of them is worth it."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from fabricated_trials import FITTED, MIMIC, PAIR, A, B, C, Dip, Mimic
from loop_fixtures import Bump, Wave

from swgsim.identification.decide import pairs
from swgsim.identification.decide.candidate import Trial
from swgsim.identification.decide.pairs import PAIR_GAIN, of_doubles, paired, worth_it
from swgsim.identification.fit.form_error import Coherence
from swgsim.identification.search.shortlist import NEARLY

UNSOUND = (Coherence(0.0, 0.0, 0.0),)


@pytest.fixture(autouse=True)
def _by_evidence(monkeypatch):
    """Fabricated trials have a merit; one with two effects is tried as the pair of them."""
    for name in ("merit", "credit"):
        monkeypatch.setattr(Trial, name, property(lambda trial: trial.evidence))
    monkeypatch.setattr(pairs, "unbent", lambda now: now)
    monkeypatch.setattr(pairs, "screened", lambda *_: ())
    monkeypatch.setattr(pairs, "tried", lambda now, score, added, start: replace(PAIR, score=score, effects=added))


def kinds(found: tuple[Trial, ...]) -> list[tuple[type, ...]]:
    return [tuple(map(type, trial.effects)) for trial in found]


@pytest.mark.parametrize(("gain", "agrees", "worth"), [(0.9, 1.0, False), (1.1, 1.0, True), (1.1, 0.0, False)])
def test_a_pair_must_gain_more_than_the_best_effect_alone_and_be_sound(gain, agrees, worth):
    both = (Coherence(1.0, 0.0, 0.0), Coherence(agrees, 0.0, 0.0))
    pair = replace(PAIR, evidence=A.evidence + gain * 2 * PAIR_GAIN, coherence=both)
    assert worth_it((pair,), A, FITTED) is (pair if worth else None)
    assert worth_it((), A, FITTED) is None


@pytest.mark.parametrize(("place", "share", "worth"), [("mesh", 0.3, False), ("mesh", 0.4, True), ("drive", 0.3, True)])
def test_in_another_structure_enough_of_what_the_second_adds_must_be_its_own(monkeypatch, place, share, worth):
    """The first may own all that it gains, and hide that its companion is credited with something else."""
    monkeypatch.setattr(Wave, "place", place)
    foreign = replace(FITTED, unit=replace(FITTED.unit, structure=0.03))
    pair = replace(PAIR, fitted=foreign, evidence=A.evidence + 100)
    pair.__dict__["signature"] = np.zeros((1, 2))
    monkeypatch.setattr(Trial, "explained", lambda *_: 2 * A.evidence + share * 200)
    monkeypatch.setattr(pairs, "gain", lambda *_: 2 * A.evidence)
    assert worth_it((pair,), A, foreign) is (pair if worth else None)


def test_pairs_are_tried_with_the_best():
    assert kinds(paired(FITTED, FITTED, (A, B, C), (), 0)) == [(Bump, Wave), (Bump, Dip)]


@pytest.mark.parametrize(
    ("less", "runner", "expected"),
    [
        (0.9 * NEARLY, B, [(Wave, Dip)]),
        (1.1 * NEARLY, B, [(Bump, Wave), (Bump, Dip)]),
        (0.9 * NEARLY, replace(B, coherence=UNSOUND), [(Bump, Wave), (Bump, Dip)]),
        (0.9 * NEARLY, replace(B, gains=-B.gains), [(Bump, Wave), (Bump, Dip)]),
    ],
    ids=["hardly worse", "worse", "contradicts itself too", "does not pay"],
)
def test_two_effects_may_look_like_a_third_that_contradicts_itself(less, runner, expected):
    best, runner = replace(A, coherence=UNSOUND), replace(runner, evidence=A.evidence * (1 - less))
    assert kinds(paired(FITTED, FITTED, (best, runner, replace(C, evidence=0.0)), (), 0)) == expected


def test_where_a_pair_with_the_best_is_worth_it_no_others_are_tried(monkeypatch):
    asked = []

    def tried(now, score, added, start):
        asked.append(tuple(map(type, added)))
        return replace(PAIR, effects=added, evidence=A.evidence + 3 * PAIR_GAIN, coherence=2 * A.coherence)

    monkeypatch.setattr(pairs, "tried", tried)
    paired(FITTED, FITTED, (replace(A, coherence=UNSOUND), B, C), (), 0)
    assert asked == [(Bump, Wave), (Bump, Dip)]


def doubles(alone: Trial, beside: Trial) -> list[tuple[type, ...]]:
    """Pairs that are tried with Mimic in the place of Bump, where Bump and Wave are 100 better than Bump."""
    accepted = replace(PAIR, evidence=A.evidence + 100)
    return kinds(of_doubles(accepted, FITTED, FITTED, (A, alone, replace(B, evidence=0.0)), (accepted, beside)))


@pytest.mark.parametrize(("less", "expected"), [(0.9, [(Mimic, Wave)]), (1.1, [])])
def test_a_double_of_the_first_stands_in_its_place(less, expected):
    double, beside = (
        replace(MIMIC, evidence=A.evidence * (1 - less * NEARLY)),
        replace(PAIR, effects=(Bump(1.0), Dip(1.0))),
    )
    assert doubles(double, beside) == expected
    assert doubles(replace(double, gains=-double.gains), beside) == []


@pytest.mark.parametrize(
    ("less", "beside", "double"),
    [(0.9, PAIR, True), (1.1, PAIR, False), (0.9, replace(PAIR, coherence=UNSOUND), False)],
    ids=["adds as much", "adds less", "contradicts itself"],
)
def test_a_double_of_the_second_adds_as_much_as_it_does(less, beside, double):
    """However little that is beside the first."""
    beside = replace(beside, effects=(Bump(1.0), Dip(1.0)), evidence=A.evidence + 100 * (1 - less * NEARLY))
    assert doubles(MIMIC, beside) == [(Mimic, Wave), *([(Mimic, Dip)] if double else [])]


def test_the_second_of_the_pair_is_no_double_of_the_first():
    beside = replace(PAIR, effects=(Bump(1.0), Dip(1.0)), evidence=A.evidence + 100)
    assert doubles(B, beside) == []


def test_a_pair_of_doubles_is_tried_once_and_none_with_itself():
    """Mimic and Dip are as good as Bump, and as Wave beside it."""
    accepted = replace(PAIR, evidence=A.evidence + 100)
    pairs = (accepted, *(replace(accepted, effects=(Bump(1.0), other(1.0))) for other in (Mimic, Dip)))
    found = kinds(of_doubles(accepted, FITTED, FITTED, (A, MIMIC, C, B), pairs))
    # Sets that are equal may print in another order, so they cannot be sorted by that.
    assert Counter(map(frozenset, found)) == Counter(map(frozenset, ([Mimic, Wave], [Mimic, Dip], [Dip, Wave])))
