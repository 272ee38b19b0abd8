from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.frozen import FULL_LOAD, TurnedDisplacement
from swgsim.effects.quantity import size
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint


@dataclass(frozen=True)
class LobeShift(Effect):
    """Load distorts the ellipse, so that its lobes turn ahead of the cam by angle T / 70 N m.

    The displacement is that at psi + angle T / 70 N m (physics.md FS7). Displacements that are fixed to the flex spline
    and listed before this effect turn too, which matters little at such angles. Wind-up between the wave generator and
    its encoder is the same.

    Signature: all lines of order k change by the phase k angle T / 70 N m, equally in opposite gauges. Typical: 1 to 5
    degrees at 70 N m (estimate).

    Attributes
    ----------
    angle : float
        At 70 N m [rad], from -0.2 to 0.2.
    """

    place = "wave generator"
    angle: float = size(unit="rad", low=-0.2, high=0.2, typical=0.05)

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The lobes where they are at the load."""
        return TurnedDisplacement(self.angle * point.T_out / FULL_LOAD)
