"""Effect: the lobes turn with load."""

from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.frozen import FULL_LOAD, TurnedDisplacement
from swgsim.effects.quantity import size
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint


@dataclass(frozen=True)
class LobeShift(Effect):
    """Load distorts the ellipse, and its lobes turn ahead of the cam by an angle in proportion to it.

    The displacement is that at psi + angle T / 70 N m (physics.md FS7); what is fixed to the flex spline and listed
    before is turned along, which matters little at such angles. Signature: all lines of order k change by the phase
    k angle T / 70 N m, alike in opposite gauges. Wind-up between the wave generator and the sensor of its angle is the
    same. Typical: 1 to 5 degrees at 70 N m (estimate).

    Attributes
    ----------
    angle : float
        At 70 N m [rad], up to 0.2 either way.
    """

    place = "wave generator"
    angle: float = size(unit="rad", low=-0.2, high=0.2, typical=0.05)

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The lobes where they are at the load."""
        return TurnedDisplacement(self.angle * point.T_out / FULL_LOAD)
