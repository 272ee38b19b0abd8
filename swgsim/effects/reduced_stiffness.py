from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class ReducedStiffness(Effect):
    """The linear stiffness k1 of eq. (2) falls, as in the first hours of run-in.

    This is a fault of Table I (section II-A, Fig. 4).

    Signature: the torque ripple that the kinematic error excites changes slightly, most visibly in s0. Typical: -20 %.

    Attributes
    ----------
    k1_ratio : float
        Remaining share of the healthy k1, from 0.5 (below, the gear is broken rather than worn) to 1.
    """

    place = "gear"
    k1_ratio: float = size(unit="-", low=0.5, high=1, typical=0.8, nothing=1)

    def gear(self, gear: Gear) -> Gear:
        """The gear with less linear stiffness."""
        return gear.with_transmission(k1=self.k1_ratio * gear.transmission.k1)
