from dataclasses import dataclass
from math import exp, log1p

from swgsim.effects.base import Effect
from swgsim.effects.quantity import shape, size
from swgsim.effects.warm_grease import WarmGrease
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint


@dataclass(frozen=True)
class GreaseSettling(Effect):
    """After a rest or new grease the wave generator churns grease until it is pushed aside, so b1 falls with time.

    Viscous friction is b1 (1 + share exp(-t / time_constant)) at the time t since the session began (physics.md DY15).

    Signature: input torque that falls with time to its usual value, more at high speed and at any load; the gauges
    hardly change. A warming gear follows another law in time. Typical: 5 to 30 % of the torque without load, minutes to
    hours.

    Attributes
    ----------
    share : float
        Of b1 at the start, from 0 to 2.
    time_constant : float
        [s], from 60 to 7200.
    """

    place = "gear"
    share: float = size(unit="-", low=0, high=2, typical=0.2)
    time_constant: float = shape(600.0, unit="s", low=60, high=7200, points=7)

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The friction at the time of the recording, as that of colder grease."""
        beta = 0.025
        more = self.share * exp(-conditions.elapsed / self.time_constant)
        return WarmGrease(-log1p(more) / beta, beta)
