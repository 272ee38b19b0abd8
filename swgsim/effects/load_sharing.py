from dataclasses import dataclass
from math import exp

from swgsim.effects.base import Effect
from swgsim.effects.frozen import FULL_LOAD, PoweredShare
from swgsim.effects.quantity import size
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint


@dataclass(frozen=True)
class LoadSharing(Effect):
    """Load bends the teeth, so more of them share it: the shares are raised to the power p = exp(-change T / 70 N m).

    The source is physics.md FS8. Without load the force follows the engagement depth (p = 1). The engaged arc stays
    +-45 degrees of each lobe; its edges carry more.

    Signature: the contribution of the teeth to even orders is not in proportion to load, equally in opposite gauges.
    Typical: 0.5, which at 70 N m takes 5 % of their order 2 and 30 % of order 4; 5 to 15 % is the estimate.

    Attributes
    ----------
    change : float
        Fall of ln p up to 70 N m, from -1 to 1.
    """

    place = "mesh"
    change: float = size(unit="-", low=-1, high=1, typical=0.5)

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The sharing at the load."""
        return PoweredShare(exp(-self.change * point.T_out / FULL_LOAD))
