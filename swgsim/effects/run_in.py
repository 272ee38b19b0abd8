from dataclasses import dataclass
from math import exp

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size
from swgsim.gear.gear import Gear

# Time constants [h] (physics.md AG1, AG2) and the share of k1 and b1 that is lost in the end. The losses follow from
# Fig. 4, -20 % of the measured stiffness after 10 h, and from Table II, +10 % of efficiency after 250 h (relative, mean
# over the paper's six operating points), for the default gear; tests/test_run_in.py solves for them again.
K1_HOURS, K1_LOSS = 3.0, 0.2272
B1_HOURS, B1_LOSS = 100.0, 0.4968


@dataclass(frozen=True)
class RunIn(Effect):
    """Teeth and wave generator settle and smooth in the first hours of operation, so k1 and b1 fall.

    The paper takes these states as its faults reduced stiffness and reduced damping (section II-A).

    Signature: the stiffness falls by 20 % within 10 h and stays; the efficiency rises by 10 % within 250 h.

    Attributes
    ----------
    hours : float
        Operating time [h], from 0 to 10 000.
    """

    place = "gear"
    hours: float = size(unit="h", low=0, high=10_000, typical=100)

    def gear(self, gear: Gear) -> Gear:
        """The gear with less stiffness k1 and less linear damping b1."""
        transmission = gear.transmission
        k1 = transmission.k1 * (1 - K1_LOSS * (1 - exp(-self.hours / K1_HOURS)))
        b1 = transmission.b1 * (1 - B1_LOSS * (1 - exp(-self.hours / B1_HOURS)))
        return gear.with_transmission(k1=k1, b1=b1)
