"""The comparison behind make matrix: it lets last bits pass and finds what is more."""

import numpy as np
import pytest
from matrix import LIBRARIES, requirements
from same_numbers import TOLERANCES, beyond, compared, table


def numbers() -> dict[str, np.ndarray]:
    """What an environment gathers, in small."""
    return {
        "signals/clean/all": np.array([[[0.5, -2.0]]], dtype="f4"),
        "facts/clean/efficiency": np.array([0.7, np.nan]),
        "facts/clean/seed": np.array([2**63, 2**63 + 1], dtype="u8"),
        "features/clean/selection_all": np.array([[1.0, 100.0], [3.0, 500.0]]),
        "metrics/table7/rf selection_1 random_folds": np.array([91.0, 80.5]),
    }


def moved(name: str, difference: float) -> dict[str, np.ndarray]:
    """The same, with one number moved so far."""
    other = numbers()
    values = other[name].copy()
    values.flat[0] += difference
    return {**other, name: values}


@pytest.mark.parametrize(
    ("name", "measure"),
    [
        ("signals/clean/all", 2.0),
        ("facts/clean/efficiency", 0.7),
        ("features/clean/selection_all", 2.0),
        ("metrics/table7/rf selection_1 random_folds", 1.0),
    ],
)
def test_what_lies_beyond_the_tolerance_is_named(name: str, measure: float) -> None:
    kind, what, of_what = name.split("/", 2)
    limit = TOLERANCES[kind].limit * measure
    near, far = (compared(numbers(), moved(name, times * limit)) for times in (0.5, 1.7))
    assert sum(row["differing"] for row in near) == 1
    assert beyond(near) == []
    (said,) = beyond(far)
    assert said.startswith(f"{kind}, {what}: {of_what} by ")
    assert of_what in table(far)


def test_whole_numbers_are_the_same_or_not() -> None:
    other = numbers() | {"facts/clean/seed": np.array([2**63, 2**63 + 2], dtype="u8")}
    assert beyond(compared(numbers(), other)) != []


def test_a_constant_feature_is_compared() -> None:
    name = "features/clean/selection_all"
    same, other = ({**numbers(), name: np.full((2, 1), value)} for value in (1.0, 1.1))
    assert beyond(compared(same, same)) == []
    assert beyond(compared(same, other)) != []


def test_numbers_that_only_one_has_are_refused() -> None:
    fewer = {name: values for name, values in numbers().items() if not name.startswith("metrics")}
    with pytest.raises(ValueError, match="only one of the two has metrics/table7/rf"):
        compared(numbers(), fewer)
    with pytest.raises(ValueError, match="NaN in different places"):
        compared(numbers(), moved("facts/clean/efficiency", np.nan))


def test_the_oldest_libraries_are_the_lower_bounds() -> None:
    pins = [each.split("==") for each in requirements("oldest")]
    assert sorted(name for name, _ in pins) == sorted(LIBRARIES)
    assert ["numpy", "2.0"] in pins
