"""The speed within which the sign of Coulomb friction changes, and the lag of the motion, fitted with the model."""

from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from swgsim.joint.regression import Fit, fit, rms
from swgsim.joint.shared import OfSign
from swgsim.joint.term import Term

# Widest change of the sign [rad/s]. Above begins Stribeck friction, which is friction that depends on the speed.
WIDEST_SIGN = 0.02
# Longest lag between a signal and the motion, either way [s]: filters of drives and of their speeds.
LONGEST_LAG = 0.02
# Values of the first search of each, and accuracy of the second in their steps.
GRID_POINTS, GRID_ACCURACY = 7, 0.05


def with_sign_width(now: Fit) -> Fit:
    """The model at the most likely width of the sign, and lag of sign and acceleration.

    Friction changes its sign at a reversal at once, but for elastic seals and grease. A measured speed with noise, or
    sampled coarsely, shows the reversal only up to a speed, below which the direction is uncertain. This is the least
    width.
    """

    def at(**motion: float) -> Fit:
        return fit(now.table, [_with(term, motion) for term in now.terms])

    def error(**motion: float) -> float:
        return rms(at(**motion).residual)

    doubts = [each.speed_doubt for each in now.table.recordings if each.reverses]
    if not doubts:
        return now
    if not any(isinstance(term, OfSign) for term in now.terms):
        if not any(_has(term, "lag") for term in now.terms):
            return now
        return at(lag=_lowest(lambda x: error(lag=x), -LONGEST_LAG, LONGEST_LAG))
    least = max(float(np.sqrt(np.mean(np.square(doubts)))), 1e-3 * WIDEST_SIGN)
    # A sign that changes within its least width has no shape of which more could be told.
    ends = np.log(least), np.log(max(WIDEST_SIGN, least * (1 + 1e-9)))
    width = _lowest(lambda x: error(sign_width=float(np.exp(x))), *ends)
    lag = _lowest(lambda x: error(sign_width=float(np.exp(width)), lag=x), -LONGEST_LAG, LONGEST_LAG)
    width = _lowest(lambda x: error(sign_width=float(np.exp(x)), lag=lag), *ends)
    return at(sign_width=float(np.exp(width)), lag=lag)


def at_longest(lag: float) -> bool:
    """Whether a lag [s] ran to its bound, as far as the search tells."""
    return LONGEST_LAG - abs(lag) < 2 * GRID_ACCURACY * 2 * LONGEST_LAG / (GRID_POINTS - 1)


def _with(term: Term, motion: Mapping[str, Any]) -> Term:
    """A term with those of some parameters that it has."""
    return replace(term, **{name: value for name, value in motion.items() if _has(term, name)})


def _has(term: Term, name: str) -> bool:
    return name in {each.name for each in fields(term)}


def _lowest(error: Callable[[float], float], low: float, high: float) -> float:
    """Place of the lowest error between two ends: on a grid, then between its neighbours."""
    grid = np.linspace(low, high, GRID_POINTS).tolist()
    best = int(np.argmin([error(x) for x in grid]))
    between = grid[max(best - 1, 0)], grid[min(best + 1, GRID_POINTS - 1)]
    refined = minimize_scalar(error, bounds=between, options={"xatol": GRID_ACCURACY * (grid[1] - grid[0])})
    return min((grid[best], float(refined.x)), key=error)
