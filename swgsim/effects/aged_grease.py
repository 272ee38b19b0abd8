from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class AgedGrease(Effect):
    """Old or scarce grease: the friction coefficient mu rises by a share, and b1 falls by half of this share.

    The source is physics.md AG6. That both go together, and by half, is an estimate.

    Signature: more input torque at high load and low speed, less at low load and high speed. The torque ripple falls by
    some per cent, as with flank friction. Typical: mu rises by 20 to 100 %.

    Attributes
    ----------
    share : float
        By which mu rises, from 0 to 1; beyond, no grease film is left.
    """

    place = "gear"
    share: float = size(unit="-", low=0, high=1, typical=0.3)

    def gear(self, gear: Gear) -> Gear:
        """The gear with aged grease."""
        t = gear.transmission
        return gear.with_transmission(mu=t.mu * (1 + self.share), b1=t.b1 * (1 - self.share / 2))
