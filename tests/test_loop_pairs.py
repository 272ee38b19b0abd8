"""Which pairs of effects are tried, and which of them is worth it."""

from dataclasses import replace

import pytest
from fabricated_trials import FITTED, MIMIC, PAIR, A, B, C, Dip, Mimic
from loop_fixtures import Bump, Wave

from swgsim.loop import pairs
from swgsim.loop.evidence import Coherence
from swgsim.loop.leading import NEARLY
from swgsim.loop.pairs import PAIR_GAIN, of_doubles, paired, runner_up, worth_it
from swgsim.loop.trial import Trial

UNSOUND = (Coherence(0.0, 0.0, 0.0),)


@pytest.fixture(autouse=True)
def _by_evidence(monkeypatch):
    """Fabricated trials have a merit; one with two effects is tried as the pair of them."""
    monkeypatch.setattr(Trial, "merit", property(lambda trial: trial.evidence))
    monkeypatch.setattr(pairs, "unbent", lambda now: now)
    monkeypatch.setattr(pairs, "screened", lambda *_: ())
    monkeypatch.setattr(pairs, "tried", lambda now, score, added, start: replace(PAIR, score=score, effects=added))


def kinds(found: tuple[Trial, ...]) -> list[tuple[type, ...]]:
    return [tuple(map(type, trial.effects)) for trial in found]


@pytest.mark.parametrize(("gain", "agrees", "worth"), [(0.9, 1.0, False), (1.1, 1.0, True), (1.1, 0.0, False)])
def test_a_pair_must_gain_more_than_its_better_half_and_be_sound(gain, agrees, worth):
    both = (Coherence(1.0, 0.0, 0.0), Coherence(agrees, 0.0, 0.0))
    pair = replace(PAIR, evidence=A.evidence + gain * 2 * PAIR_GAIN, coherence=both)
    assert worth_it((pair,), A) is (pair if worth else None)
    assert worth_it((), A) is None


def test_pairs_are_tried_with_the_best():
    assert kinds(paired(FITTED, FITTED, (A, B, C), (), 0)) == [(Bump, Wave), (Bump, Dip)]


@pytest.mark.parametrize(
    ("less", "runner", "expected"),
    [
        (0.9 * NEARLY, B, [(Wave, Dip)]),
        (1.1 * NEARLY, B, [(Bump, Wave), (Bump, Dip)]),
        (0.9 * NEARLY, replace(B, coherence=UNSOUND), [(Bump, Wave), (Bump, Dip)]),
    ],
    ids=["hardly worse", "worse", "contradicts itself too"],
)
def test_two_effects_may_look_like_a_third_that_contradicts_itself(less, runner, expected):
    best, runner = replace(A, coherence=UNSOUND), replace(runner, evidence=A.evidence * (1 - less))
    far = replace(C, evidence=0.0)
    assert kinds(paired(FITTED, FITTED, (best, runner, far), (), 0)) == expected
    assert runner_up((best, runner, far)) is (runner if len(expected) == 1 else None)


def test_where_a_pair_with_the_best_is_worth_it_no_others_are_tried(monkeypatch):
    gains = PAIR.evidence + 3 * PAIR_GAIN
    monkeypatch.setattr(
        pairs, "tried", lambda now, score, added, start: replace(PAIR, effects=added, evidence=gains, coherence=both)
    )
    both = 2 * (Coherence(1.0, 0.0, 0.0),)
    best = replace(A, coherence=UNSOUND)
    assert kinds(paired(FITTED, FITTED, (best, B, C), (), 0)) == [(Bump, Wave), (Bump, Dip)]


@pytest.mark.parametrize("nearly", [True, False])
def test_doubles_of_both_members_make_a_pair(nearly):
    """Mimic is as good as Bump alone, and Dip is as good as Wave beside it."""
    less = 0.9 * NEARLY if nearly else 1.1 * NEARLY
    double = replace(MIMIC, evidence=A.evidence * (1 - less))
    beside = replace(PAIR, effects=(Bump(1.0), Dip(1.0)))
    found = of_doubles(PAIR, FITTED, FITTED, (A, double, replace(B, evidence=0.0)), (PAIR, beside))
    assert kinds(found) == ([(Mimic, Wave), (Mimic, Dip)] if nearly else [])


def test_doubles_make_no_pair_with_themselves():
    beside = replace(PAIR, effects=(Bump(1.0), Mimic(1.0)))
    assert kinds(of_doubles(PAIR, FITTED, FITTED, (A, MIMIC, B), (PAIR, beside))) == [(Mimic, Wave)]
