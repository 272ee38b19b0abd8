from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.frozen import FULL_LOAD, ScaledDisplacement
from swgsim.effects.quantity import size
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint


@dataclass(frozen=True)
class Coning(Effect):
    """Under load the contact moves along the coned sleeve, and the collar feels another deflection.

    The sleeve deflects in proportion to the distance from the collar (physics.md FS6), so the imposed displacement
    changes by the factor 1 + share T / 70 N m.

    Signature: orders 2 and 4 of the deflection change in proportion to load, equally in opposite gauges. The pattern of
    the tooth forces stays. Typical: 5 to 20 % of order 2 from 7 to 70 N m (estimate).

    Attributes
    ----------
    share : float
        Change of the deflection at 70 N m, from -0.3 to 0.3.
    """

    place = "wave generator"
    share: float = size(unit="-", low=-0.3, high=0.3, typical=0.1)

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The deflection at the load."""
        return ScaledDisplacement(1 + self.share * point.T_out / FULL_LOAD)
