from dataclasses import dataclass
from math import exp

from swgsim.effects.base import Effect
from swgsim.effects.quantity import shape, size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class WarmGrease(Effect):
    """Viscous friction falls with temperature: b1 exp(-beta dT) (physics.md DY3).

    Signature: higher efficiency, as with reduced damping; 12 to 20 K more look like b1 reduced by one third. Typical:
    beta 0.02 to 0.035 per K (robot joints lose 17 to 20 % of their viscous friction while warming up).

    Attributes
    ----------
    dT : float
        Temperature above the one at which b1 holds [K], from -60 to 80.
    beta : float
        [1/K], from 0 to 0.1.
    """

    place = "gear"
    dT: float = size(unit="K", low=-60, high=80, typical=15)
    beta: float = shape(0.025, unit="1/K", low=0, high=0.1)

    def gear(self, gear: Gear) -> Gear:
        """The gear with its viscous friction at the temperature."""
        return gear.with_transmission(b1=gear.transmission.b1 * exp(-self.beta * self.dT))
