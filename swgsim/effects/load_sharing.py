"""Effect: more teeth share a higher load."""

from dataclasses import dataclass
from math import exp

from swgsim.effects.base import Effect
from swgsim.effects.frozen import FULL_LOAD, PoweredShare
from swgsim.effects.quantity import size
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint


@dataclass(frozen=True)
class LoadSharing(Effect):
    """Load bends the teeth and spreads over more of them: share^p with p = exp(-change T / 70 N m) (physics.md FS8).

    Without load, the force follows the engagement depth (p = 1); the engaged arc stays +-45 degrees of each lobe, only
    its edges carry more. Signature: what the teeth contribute to even orders bends away from proportion to load, alike
    in opposite gauges. Typical: 0.5, which at 70 N m takes 5 % of their order 2 and 30 % of order 4; 5 to 15 % is the
    estimate.

    Attributes
    ----------
    change : float
        Fall of ln p up to 70 N m, up to 1 either way.
    """

    place = "mesh"
    change: float = size(unit="-", low=-1, high=1, typical=0.5)

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The sharing at the load."""
        return PoweredShare(exp(-self.change * point.T_out / FULL_LOAD))
