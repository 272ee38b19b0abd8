"""Statistics of the study on trials whose causes are known."""

import numpy as np
import pytest

from learn.paper.published_tables import paper_table
from learn.paper_choices.analysis import best_of, effects, fit, held, reduced
from learn.paper_choices.choice import Choice
from learn.paper_choices.search import Trial

CHOICES = [
    Choice(name, usual=1.0, low=0.1, high=10.0, unit="-", meaning=name, source="", fitted=name != "unseen")
    for name in ("cause", "other", "unseen")
]


def trials(count=40, seed=0, holds=lambda x: {"C1": True, "C2": x[0] > 0, "C3": False}):
    """Scores of Table X that rise by 5 points for a standard deviation of the first choice."""
    rng = np.random.default_rng(seed)
    cells = len(paper_table("table10"))
    made = []
    for x in rng.normal(size=(count, 3)).clip(-2, 2):
        scores = (70 + 5 * x[0] + rng.normal(scale=0.5, size=cells)).tolist()
        values = {each.name: each.value(each.share(10 ** (x[i] / 2))) for i, each in enumerate(CHOICES)}
        made.append(Trial(True, values, float(3 + abs(x[0] - 1)), {"table10": scores}, holds(x)))
    return made


def test_the_effect_of_a_choice_on_a_cell_is_recovered():
    found = effects(trials(400), CHOICES)
    assert found["cause"].mean() == pytest.approx(5, abs=0.2)
    assert abs(found["other"].mean()) < 0.7


def test_a_claim_depends_on_the_choice_that_decides_it():
    found = held(trials(), CHOICES)
    assert (found["C1"].words, found["C3"].words) == ("always", "never")
    assert found["C2"].depends_on == ("cause",)


def test_a_claim_that_holds_by_chance_depends_on_nothing_but_rarely():
    rng = np.random.default_rng(1)
    named = sum(
        bool(held(trials(seed=seed, holds=lambda _: {"C1": bool(rng.random() < 0.5)}), CHOICES)["C1"].depends_on)
        for seed in range(60)
    )
    assert named <= 8  # 3 expected, more than 8 once in two hundred such tests


def test_what_fits_as_well_is_within_the_scatter_of_the_best():
    made = trials()
    best = best_of(made, CHOICES)
    near, wide = (fit(best, best.values, made, deviation, CHOICES) for deviation in (0.1, 0.5))
    low, high = near.intervals["cause"]
    assert low <= best.values["cause"] <= high
    assert near.as_well < wide.as_well
    assert wide.intervals["cause"][0] <= low
    assert low > 1  # the scores want more of the cause than is usual
    assert "unseen" not in near.intervals  # the scores say nothing of it


def test_choices_are_put_back_together_as_long_as_the_rest_fits():
    """Two of three choices cost little alone, and too much together; folds and forests scatter both alike."""
    values, costs = {"cause": 4.0, "other": 3.0, "unseen": 2.0}, {"cause": 2.0, "other": 0.3, "unseen": 0.2}
    scatter = np.array([-1.0, 0.0, 0.0, 1.0])

    def alone(sets):
        return [5 + sum(costs[name] for name in costs if each[name] == 1.0) for each in sets]

    def repeated(each):
        own = {"cause": [0, 1, 0, -1], "other": [1, -1, 0, 0], "unseen": [0, 0, 1, -1]}
        noise = sum(np.array(own[name]) for name in costs if each[name] == 1.0)
        return alone([each])[0] + 10 * scatter + 0.3 * noise

    found, deviation = reduced(values, CHOICES, alone, repeated)
    assert found == {"cause": 4.0, "other": 3.0, "unseen": 1.0}
    assert deviation == pytest.approx(0.3, rel=0.3)


def test_a_best_trial_with_usual_values_alone_has_the_scatter_of_independent_seeds():
    usual = {each.name: each.usual for each in CHOICES}
    found, deviation = reduced(usual, CHOICES, lambda sets: [], lambda _: np.array([4.0, 5.0, 6.0]))
    assert found == usual
    assert deviation == pytest.approx(np.sqrt(2))


def test_what_the_fit_does_not_see_keeps_its_usual_value():
    assert best_of(trials(), CHOICES).values["unseen"] == 1.0
