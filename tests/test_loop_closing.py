"""What closing the loop makes of what asking says: effects asked again with all the others, and rivals."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from loop_fixtures import BUMP, WAVE, Bump, Wave, fitted_to

from swgsim.loop import closing
from swgsim.loop.asking import ALPHA, Round
from swgsim.loop.closing import Step
from swgsim.loop.evidence import FORM_TOLERANCE, Coherence
from swgsim.loop.features import Layout
from swgsim.loop.hypotheses import Hypothesis
from swgsim.loop.screening import Score
from swgsim.loop.trial import Trial

FITTED = fitted_to(Layout(("T_in", "s1")), np.random.default_rng(1))


@dataclass(frozen=True)
class Dip(Bump):
    """Another effect."""


@dataclass(frozen=True)
class Mimic(Bump):
    """An effect that looks like a bump."""


def tried(hypothesis: Hypothesis, evidence: float = 1000.0, agrees: float = 1.0) -> Trial:
    score = Score(hypothesis, 100.0, 1, 1.0, 0.0, 0.1, 1.0, 1e-6)
    return Trial(score, (hypothesis.kind(1.0),), FITTED, np.full(6, 50.0), evidence, (Coherence(agrees, 0.0, 0.0),))


A, B, C, MIMIC = (tried(each) for each in (BUMP, WAVE, Hypothesis(Dip, (), 1), Hypothesis(Mimic, (), 1)))


def kinds(steps: tuple[Step, ...]) -> tuple[type, ...]:
    return tuple(type(effect) for step in steps for effect in step.accepted.effects)


def backward(monkeypatch, said: list[Round], *first: Trial) -> tuple[tuple[type, ...], list[tuple[type, ...]]]:
    """Effects after the backward pass, and beside which others each was asked."""
    beside = []

    def joined(base, steps):
        beside.append(kinds(tuple(steps)))
        return base

    monkeypatch.setattr(closing, "_joined", joined)
    monkeypatch.setattr(closing, "screened", lambda *_: ())
    monkeypatch.setattr(closing, "ask", lambda *_: said.pop(0))
    kept = closing._backward(FITTED, tuple(Step(trial, (), ()) for trial in first), (), 0)
    return kinds(kept), beside


@pytest.mark.parametrize(
    ("said", "left"),
    [
        (Round((A, MIMIC), A, None), (Bump, Wave)),
        (Round((MIMIC, A), MIMIC, None), (Mimic, Wave)),
        (Round((), None, None), (Wave,)),
        (Round((MIMIC,), None, None), (Bump, Wave)),
    ],
    ids=["still the best", "another was meant", "nothing stands out any more", "what stands out is not accepted"],
)
def test_the_first_effect_is_asked_again_beside_the_second(monkeypatch, said, left):
    assert backward(monkeypatch, [said], A, B) == (left, [(Wave,)])


def test_later_effects_are_asked_beside_what_the_earlier_ones_became(monkeypatch):
    said = [Round((MIMIC,), MIMIC, None), Round((), None, None)]
    assert backward(monkeypatch, said, A, B, C) == ((Mimic, Dip), [(Wave, Dip), (Mimic, Dip)])


def rivals(other: Trial, chance: float) -> tuple[Trial, ...]:
    """Rivals of an effect, where the other one is as unlikely as this once that is in the model."""
    after = (replace(other.score, chance=chance),)
    step = closing._with_rivals(Step(A, (), (other,)), after)
    assert {*step.rivals, *step.others} == {other}
    return step.rivals


@pytest.mark.parametrize(("less", "rival"), [(0.9, True), (1.1, False)])
def test_what_an_imperfect_form_may_cost_does_not_tell_rivals(less, rival):
    other = tried(MIMIC.score.hypothesis, A.evidence * (1 - less * FORM_TOLERANCE**2))
    assert rivals(other, 2 * ALPHA) == ((other,) if rival else ())


@pytest.mark.parametrize(("chance", "agrees"), [(ALPHA / 2, 1.0), (2 * ALPHA, 0.0)])
def test_what_says_more_or_contradicts_itself_is_no_rival(chance, agrees):
    assert rivals(tried(MIMIC.score.hypothesis, agrees=agrees), chance) == ()
