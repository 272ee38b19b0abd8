from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.quantity import angle
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class OutputPosition(Effect):
    """The output stands at another angle when the recording begins, which shifts b3 sin(phi_out + theta_b) of eq. (5).

    A run of the chain always begins near phi_out = 0; on a bench the angle differs from recording to recording.

    Signature: the efficiency varies by b3 over b0, a few per cent of the constant friction. Typical: any angle.

    Attributes
    ----------
    angle : float
        Of the output, in the sense of eq. (5) [rad].
    """

    place = "gear"
    angle: float = angle()

    def gear(self, gear: Gear) -> Gear:
        """The gear with its output turned on."""
        return gear.with_transmission(theta_b=gear.transmission.theta_b + self.angle)
