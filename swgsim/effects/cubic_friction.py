from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class CubicFriction(Effect):
    """Viscous friction is not in proportion to speed: the cubic coefficient b2 of eq. (5) changes.

    Below 0, friction grows slower than speed (physics.md section 1.3).

    Signature: input torque that changes with the third power of speed, equally at every load; the gauges hardly change.
    Typical: -1e-3. With it, b1 and b2 follow the churning of grease, n^(2/3), up to 4500 rpm.

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
        return gear.with_transmission(b2=gear.transmission.b2 + self.b2)
