"""Effect: where the output stands when the recording begins."""

from dataclasses import dataclass, replace

from swgsim.effects.base import Effect
from swgsim.effects.quantity import angle
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class OutputPosition(Effect):
    """The friction b3 sin(phi_out + theta_b) of eq. (5) depends on the output's angle, which changes from one recording
    to the next while a run of the chain always begins near phi_out = 0.

    Signature: efficiency varies by b3 over b0, a few per cent of the dry friction. Typical: any angle.

    Attributes
    ----------
    angle : float
        Of the output, in the sense of eq. (5) [rad].
    """

    place = "gear"
    angle: float = angle()

    def gear(self, gear: Gear) -> Gear:
        """The gear with its output turned on."""
        transmission = gear.transmission
        return replace(gear, transmission=replace(transmission, theta_b=transmission.theta_b + self.angle))
