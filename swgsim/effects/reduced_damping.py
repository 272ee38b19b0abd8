"""Fault: reduced damping."""

from dataclasses import dataclass, replace

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class ReducedDamping(Effect):
    """The linear damping b1 of eq. (5) drops, as flanks smooth and grease spreads during run-in (section II-A).

    Signature: higher efficiency, gauges all but untouched. Typical: b1 falls by one third, efficiency rises by 7 %.

    Attributes
    ----------
    b1_ratio : float
        Remaining share of the healthy b1, from 0.3 (below, no grease film is left) to 1.
    """

    place = "gear"
    b1_ratio: float = size(unit="-", low=0.3, high=1, typical=2 / 3, nothing=1)

    def gear(self, gear: Gear) -> Gear:
        """The gear with less linear damping."""
        transmission = gear.transmission
        return replace(gear, transmission=replace(transmission, b1=self.b1_ratio * transmission.b1))
