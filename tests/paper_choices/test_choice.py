"""Choices: their priors, and what is refused."""

import numpy as np
import pytest

from learn.paper_choices.choice import Choice


def choice(**changed):
    options = {"usual": 1.0, "low": 0.01, "high": 3.0, "unit": "-", "meaning": "", "source": ""}
    return Choice("mass", **(options | changed))


@pytest.mark.parametrize("options", [{}, {"scale": "linear", "low": 0.0}, {"usual": 0.01}])
def test_values_stay_in_their_range_and_have_the_share_that_they_were_drawn_for(options):
    one, shares = choice(**options), np.linspace(0.001, 0.999, 21)
    values = [one.value(share) for share in shares]
    assert (np.diff(values) > 0).all()
    assert one.low <= values[0]
    assert values[-1] <= one.high
    np.testing.assert_allclose([one.share(value) for value in values], shares, atol=1e-9)


def test_two_standard_deviations_cost_two_units_and_span_half_the_range():
    one = choice(low=0.1, high=10.0)
    assert one.cost(1.0) == 0
    assert one.cost(10.0) == pytest.approx(2)
    assert one.cost(0.1) == pytest.approx(2)


def test_yes_and_no_are_equally_plausible():
    one = choice(scale="yes_no", low=0, high=1, usual=1)
    assert [one.value(share) for share in (0.1, 0.49, 0.51, 0.9)] == [1, 1, 0, 0]
    assert one.value(one.share(0.0)) == 0
    assert one.cost(0.0) == one.cost(1.0) == 0


def test_numbers_of_things_are_whole():
    assert {choice(integer=True, low=1, usual=6, high=25).value(share) % 1 for share in (0.1, 0.4, 0.8)} == {0.0}


@pytest.mark.parametrize(
    ("options", "message"),
    [({"usual": 4.0}, "usual"), ({"low": 5.0}, "swap"), ({"scale": "cubic"}, "log, linear, yes_no")],
)
def test_a_choice_without_a_valid_prior_is_refused(options, message):
    with pytest.raises(ValueError, match=message):
        choice(**options)
