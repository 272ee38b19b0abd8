"""The decision of the least expected cost, against thresholds by hand."""

import pytest

from swgsim.storage.labelled_signals import CLASSES
from swgsim.twin.costs import COSTS, costs_with, expected


def cheapest(crack: float, **changed) -> str:
    return next(iter(expected(costs_with(changed), {"healthy": 1 - crack, "root_tooth_crack": crack})))


def test_thresholds_are_those_of_the_prices() -> None:
    """To inspect pays from 0.1 + p = 10 p on, and to replace at once from 0.1 + p = 1 on."""
    assert [cheapest(p) for p in (0.0, 0.011, 0.0112, 0.89, 0.91, 1.0)] == [
        "leave", "leave", "inspect", "inspect", "replace", "replace"
    ]  # fmt: skip


def test_costs_of_a_workshop_move_the_thresholds() -> None:
    assert cheapest(0.05, leave={"root_tooth_crack": 1.0}) == "leave"
    assert cheapest(0.002, leave={"root_tooth_crack": 100.0}) == "inspect"
    assert set(costs_with({})["replace"]) == set(CLASSES)
    assert COSTS["leave"]["root_tooth_crack"] == 10  # what was given does not change the default


def test_mistakes_are_named() -> None:
    with pytest.raises(ValueError, match="decisions of the costs"):
        costs_with({"repair": {"healthy": 1.0}})
    with pytest.raises(ValueError, match="classes of the costs of leave"):
        costs_with({"leave": {"crack": 1.0}})
    with pytest.raises(ValueError, match="healthy"):
        costs_with({"leave": {"healthy": -1.0}})
