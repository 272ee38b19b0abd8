from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size
from swgsim.effects.warm_grease import WarmGrease
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint


@dataclass(frozen=True)
class GreaseTemperature(Effect):
    """Viscous friction follows the temperature of each recording, b1 exp(-beta (temperature - 25 degC)).

    This is warm grease with a known temperature (physics.md DY3).

    Signature: input torque that falls from cold to warm recordings, more at high speed, and no change at 25 degC; the
    gauges hardly change. If all recordings are equally warm, it equals a change of b1. Typical: 0.02 to 0.035 per K.

    Attributes
    ----------
    beta : float
        [1/K], from 0 to 0.1.
    """

    place = "gear"
    beta: float = size(unit="1/K", low=0, high=0.1, typical=0.025)

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The grease at the temperature of the recording."""
        return WarmGrease(conditions.warmer, self.beta)
