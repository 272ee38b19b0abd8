from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class ReducedDamping(Effect):
    """Flanks smooth and grease spreads during run-in, so the linear damping b1 of eq. (5) falls.

    This is a fault of Table I (section II-A).

    Signature: higher efficiency; the gauges hardly change. Typical: with b1 lower by one third, the efficiency is
    higher by 7 %.

    Attributes
    ----------
    b1_ratio : float
        Remaining share of the healthy b1, from 0.3 (below, no grease film is left) to 1.
    """

    place = "gear"
    b1_ratio: float = size(unit="-", low=0.3, high=1, typical=2 / 3, nothing=1)

    def gear(self, gear: Gear) -> Gear:
        """The gear with less linear damping."""
        return gear.with_transmission(b1=self.b1_ratio * gear.transmission.b1)
