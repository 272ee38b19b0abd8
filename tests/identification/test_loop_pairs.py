"""Which pairs of effects are tried, and which of them is worth it."""

from dataclasses import replace

import pytest
from fabricated_trials import FITTED, PAIR, A, B, C, Dip
from loop_fixtures import Bump, Wave
from swgsim.identification.decide.candidate import Trial
from swgsim.identification.decide.pairs import PAIR_GAIN, paired, worth_it

from swgsim.identification.decide import pairs
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
