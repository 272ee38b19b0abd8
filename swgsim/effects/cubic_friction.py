"""Effect: viscous friction that does not grow in proportion to speed."""

from dataclasses import dataclass, replace

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class CubicFriction(Effect):
    """The cubic friction b2 of eq. (5): below 0, friction grows slower than speed (physics.md section 1.3).

    Signature: input torque that changes with the third power of speed, at every load alike; gauges all but untouched.
    Typical: -1e-3, with which b1 and b2 together follow the churning of grease, n^(2/3), up to 4500 rpm.

    Attributes
    ----------
    b2 : float
        Added to that of the gear [N m s^3/rad^3], from -2.5e-3, below which friction would fall with speed before
        4000 rpm, to 2.5e-3.
    """

    place = "gear"
    b2: float = size(unit="N m s^3/rad^3", low=-2.5e-3, high=2.5e-3, typical=-1e-3)

    def gear(self, gear: Gear) -> Gear:
        """The gear with more or less cubic friction."""
        transmission = gear.transmission
        return replace(gear, transmission=replace(transmission, b2=transmission.b2 + self.b2))
