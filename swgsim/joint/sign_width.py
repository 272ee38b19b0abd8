"""The speed within which the sign of Coulomb friction changes, fitted with the model."""

from dataclasses import replace

import numpy as np
from scipy.optimize import minimize_scalar

from swgsim.joint.regression import Fit, fit
from swgsim.joint.shared import OfSign

# Widest change of the sign [rad/s]. Above begins Stribeck friction, which is friction that depends on the speed.
WIDEST = 0.02
# Values of the first search, evenly in the logarithm.
POINTS = 8


def with_sign_width(now: Fit) -> Fit:
    """The model at the most likely width of the sign.

    Friction changes its sign at a reversal at once, but for elastic seals and grease. A measured speed with noise, or
    sampled coarsely, shows the reversal only up to a speed, below which the direction is uncertain. This is the least
    width.
    """
    doubts = [each.speed_doubt for each in now.table.recordings if each.reverses]
    if not doubts or not any(isinstance(term, OfSign) for term in now.terms):
        return now
    least = max(float(np.sqrt(np.mean(np.square(doubts)))), 1e-3 * WIDEST)
    widest = max(WIDEST, least)

    def at(width: float) -> Fit:
        terms = [replace(term, sign_width=width) if isinstance(term, OfSign) else term for term in now.terms]
        return fit(now.table, terms)

    grid = np.linspace(np.log(least), np.log(widest), POINTS)
    best = int(np.argmin([at(float(np.exp(x))).error for x in grid]))
    ends = grid[max(best - 1, 0)], grid[min(best + 1, POINTS - 1)]
    found = float(np.exp(grid[best]))
    if ends[0] < ends[1]:
        refined = minimize_scalar(lambda x: at(float(np.exp(x))).error, bounds=ends, options={"xatol": 1e-2})
        found = min((found, float(np.exp(refined.x))), key=lambda width: at(width).error)
    return at(found)
