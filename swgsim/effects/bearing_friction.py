from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.load_dependent_friction import RATED
from swgsim.effects.quantity import size
from swgsim.effects.seal_friction import SealFriction
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint


@dataclass(frozen=True)
class BearingFriction(Effect):
    """The load presses on the balls of the wave generator: the input is braked by T T_out / 31 N m.

    This is Palmgren's M1 (physics.md section 2.2). It also stands for the part of the flex spline's hysteresis loss
    that grows with the load (FS17).

    Signature: input torque in proportion to the load at every speed; the gauges do not change. Flank friction is nearly
    the same in the input torque, but it also dampens the torque ripple. Typical: 7 mN m, 8 % of the losses at rated
    torque.

    Attributes
    ----------
    T : float
        At the input at rated torque [N m], from 0 to 0.02.
    """

    place = "drive"
    T: float = size(unit="N m", low=0, high=0.02, typical=0.007)

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The friction at the load that is set."""
        return SealFriction(self.T * point.T_out / RATED)
