"""The smallest size that would be seen is that of which so much is visible, also where this goes with the size."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from loop_fixtures import fitted_to
from scipy.stats import norm

from swgsim.effects.reduced_stiffness import ReducedStiffness
from swgsim.identification.data.features import Layout
from swgsim.identification.search import detection_limit as seen
from swgsim.identification.search.hypotheses import Hypothesis
from swgsim.identification.search.screening import ALPHA, DEVIATIONS_AT_LIMIT, Score

FITTED = fitted_to(Layout(("s1",)), np.random.default_rng(1))
TYPICAL = 0.2


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> Callable[..., tuple[Score, int]]:
    """The score of an effect whose deviation goes with the size at which it is seen, and how often that was asked."""

    def smallest(deviation: Callable[[float], float], visible: float = 0.01) -> tuple[Score, int]:
        asked = []

        def rank(hypotheses: list[Hypothesis], *_: object) -> list[Score]:
            asked.extend(hypotheses)
            return [scored(each, deviation, visible) for each in hypotheses]

        monkeypatch.setattr(seen, "rank", rank)
        monkeypatch.setattr(seen, "signatures", lambda *_: [])
        (found,) = seen.at_sizes_seen([scored(Hypothesis(ReducedStiffness, (), 1), deviation, visible)], FITTED)
        return found, len(asked)

    return smallest


def scored(hypothesis: Hypothesis, deviation: Callable[[float], float], visible: float) -> Score:
    return Score(hypothesis, 0.0, 1, 1.0, 0.0, deviation(1 - hypothesis.typical), visible, 1.0)


def test_of_an_effect_in_a_straight_line_it_stays(asked):
    found, _ = asked(lambda _: 0.004)
    assert found.detectable == pytest.approx(DEVIATIONS_AT_LIMIT * 0.004)
    assert found.value_at_limit == pytest.approx(1 - DEVIATIONS_AT_LIMIT * 0.004)


@pytest.mark.parametrize("at_typical", [0.001, 0.006, 0.03])
def test_of_a_curve_it_is_the_size_that_its_own_signature_shows(asked, at_typical):
    """A curve's half as much leaves a quarter to be seen, so that its deviation is twice as large."""
    found, _ = asked(lambda size: at_typical * TYPICAL / size)
    assert found.detectable == pytest.approx(DEVIATIONS_AT_LIMIT * at_typical * TYPICAL / found.detectable)
    assert found.detectable == pytest.approx((DEVIATIONS_AT_LIMIT * at_typical * TYPICAL) ** 0.5)


def test_of_what_shows_nothing_below_a_threshold_it_is_the_typical_size(asked):
    found, _ = asked(lambda size: 0.004 if size > 0.1 else float("inf"))
    assert found.detectable == pytest.approx(TYPICAL)


def test_what_is_mostly_visible_or_absorbed_is_not_asked_again(asked):
    assert asked(lambda size: 0.001 / size, visible=0.5)[1] == 0
    found, again = asked(lambda _: 1.0)
    assert (found.absorbed, again) == (True, 0)


def test_the_other_figures_of_a_score_stay(asked):
    found, _ = asked(lambda size: 0.001 / size)
    assert replace(found, deviation=0.0) == replace(
        scored(Hypothesis(ReducedStiffness, (), 1), lambda _: 0.0, 0.01), deviation=0.0
    )


def test_a_size_that_is_seen_stands_out_four_times_in_five():
    """Of three hundred hypotheses at the level at which effects are accepted."""
    assert pytest.approx(norm.isf(ALPHA / 300 / 2) + norm.isf(0.2), abs=0.01) == DEVIATIONS_AT_LIMIT
