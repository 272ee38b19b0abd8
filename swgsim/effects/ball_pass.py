"""Imperfection: ball pass order of the wave generator's bearing."""

from dataclasses import dataclass

from swgsim.effects.bearing_order import BearingOrder
from swgsim.effects.quantity import choice, shape


@dataclass(frozen=True)
class BallPass(BearingOrder):
    """Balls pass a place of the outer ring, which stays with the flex spline, or of the inner one, which turns.

    Form and signature are those of :class:`BearingOrder`. Typical: 0.05 to 0.5 % of order 2, at orders 9.3 to 10.6 of
    the outer ring and 11.3 to 12.8 of the inner one for 21 to 23 balls (physics.md FS11).

    Attributes
    ----------
    order : float
        From 9 to 13.
    waves : int
        Balls modulo 4, such as 2 for 22 balls.
    """

    order: float = shape(10.0, unit="-", low=9, high=13, points=49)
    waves: int = choice(2, low=0, high=3)
