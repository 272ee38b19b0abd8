from dataclasses import dataclass

from swgsim.effects.bearing_order import BearingOrder
from swgsim.effects.quantity import choice, shape


@dataclass(frozen=True)
class BallPass(BearingOrder):
    """Balls of the wave generator's bearing pass a flaw of the outer race, which stands, or the inner, which turns.

    Form and signature are those of :class:`BearingOrder`. Typical: 0.05 to 0.5 % of order 2. For 21 to 23 balls the
    order is 9.3 to 10.6 for the outer race and 11.3 to 12.8 for the inner one (physics.md FS11).

    Attributes
    ----------
    order : float
        From 9 to 13.
    waves : int
        Balls modulo 4, such as 2 for 22 balls.
    """

    order: float = shape(10.0, unit="-", low=9, high=13, points=49)
    waves: int = choice(2, low=0, high=3)
