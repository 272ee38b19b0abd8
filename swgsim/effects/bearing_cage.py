from dataclasses import dataclass

from swgsim.effects.bearing_order import BearingOrder
from swgsim.effects.quantity import shape


@dataclass(frozen=True)
class BearingCage(BearingOrder):
    """Unequal balls load the sleeve as the cage carries them around, once in a little over two revolutions.

    Form and signature are those of :class:`BearingOrder`, with one wave for a single thick ball. Typical: 0.1 to 1 % of
    order 2, at order 0.445 to 0.46 (physics.md FS11).

    Attributes
    ----------
    order : float
        Half of 1 - ball diameter / pitch diameter, from 0.44 to 0.47.
    """

    order: float = shape(0.455, unit="-", low=0.44, high=0.47, points=7)
