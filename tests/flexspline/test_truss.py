"""The truss against closed form."""

import numpy as np
import pytest

from swgsim.flexspline.truss import Factorised, Truss


def test_single_bar_stretches_by_force_over_stiffness() -> None:
    truss = Truss(np.array([[0.0, 0, 0], [2.0, 0, 0]]), np.array([[0, 1]]), np.array([5.0]))
    held = np.array([True] * 3 + [False, True, True])
    u = Factorised(truss.matrix, held).solve(np.array([0, 0, 0, 10.0, 0, 0]), np.zeros(6))
    assert u[3] == pytest.approx(2.0)


def test_symmetric_two_bar_truss() -> None:
    """Two bars at +-60 degrees to the load: the tip moves by P / (2 k cos^2 a)."""
    angle, k, load = np.pi / 3, 7.0, 3.0
    legs = [[np.sin(sign * angle), 0, np.cos(angle)] for sign in (-1, 1)]
    truss = Truss(np.array([[0.0, 0, 0], *legs]), np.array([[0, 1], [0, 2]]), np.array([k, k]))
    held = np.array([False, True, False] + [True] * 6)
    u = Factorised(truss.matrix, held).solve(np.array([0, 0, -load] + [0.0] * 6), np.zeros(9))
    assert u[2] == pytest.approx(-load / (2 * k * np.cos(angle) ** 2))
    assert u[0] == pytest.approx(0, abs=1e-12)


def test_prescribed_displacement_carries_over() -> None:
    truss = Truss(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), np.array([[0, 1], [1, 2]]), np.array([1.0, 3.0]))
    held = np.array([True] * 3 + [False, True, True] + [True] * 3)
    moved = np.zeros(9)
    moved[6] = 4.0
    assert Factorised(truss.matrix, held).solve(np.zeros(9), moved)[3] == pytest.approx(3.0)


@pytest.mark.parametrize("stiffness", [-1.0, np.nan, np.inf])
def test_impossible_stiffness_is_named(stiffness: float) -> None:
    with pytest.raises(ValueError, match=rf"stiffness of bar 0 is {stiffness} N/m, must be finite and at least 0"):
        Truss(np.array([[0.0, 0, 0], [1, 0, 0]]), np.array([[0, 1]]), np.array([stiffness]))


def test_bars_that_lead_nowhere_are_named() -> None:
    nodes = np.array([[0.0, 0, 0], [0, 0, 0]])
    with pytest.raises(ValueError, match="length 0"):
        Truss(nodes, np.array([[0, 1]]), np.array([1.0]))
    with pytest.raises(ValueError, match="node 2"):
        Truss(nodes, np.array([[0, 2]]), np.array([1.0]))
