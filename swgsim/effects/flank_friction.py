from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class FlankFriction(Effect):
    """The flanks have another friction coefficient mu in eq. (5), by lost or better lubrication.

    The source is physics.md DY4 and section 5.

    Signature: input torque that grows with the load and hardly with speed. The torque ripple falls by 2 to 5 % for 30 %
    more mu, as the flanks brake it. Typical: mu from 0.05 to 0.12 in boundary lubrication.

    Attributes
    ----------
    mu_ratio : float
        Factor on mu, from 0.3 (a full film) to 3 (dry steel).
    """

    place = "gear"
    mu_ratio: float = size(unit="-", low=0.3, high=3, typical=1.3, nothing=1)

    def gear(self, gear: Gear) -> Gear:
        """The gear with its friction coefficient scaled."""
        return gear.with_transmission(mu=self.mu_ratio * gear.transmission.mu)
