from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class ParameterScatter(Effect):
    """Damping and stiffness of the same gear differ slightly between recordings, by grease and seating (estimate).

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
        return gear.with_transmission(b1=self.b1_ratio * t.b1, k1=self.k1_ratio * t.k1)
