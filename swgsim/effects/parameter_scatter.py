"""Effect: scatter of the gear's parameters from one recording to the next."""

from dataclasses import dataclass, replace

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class ParameterScatter(Effect):
    """Damping and stiffness of the same gear differ a little between recordings (grease, seating); an estimate.

    Attributes
    ----------
    b1_ratio, k1_ratio : float
        Factors on b1 and k1, from 0.8 to 1.2.
    """

    place = "gear"
    b1_ratio: float = size(unit="-", low=0.8, high=1.2, typical=1.02, nothing=1)
    k1_ratio: float = size(unit="-", low=0.8, high=1.2, typical=1.02, nothing=1)

    def gear(self, gear: Gear) -> Gear:
        """The gear with both parameters scaled."""
        t = gear.transmission
        return replace(gear, transmission=replace(t, b1=self.b1_ratio * t.b1, k1=self.k1_ratio * t.k1))
