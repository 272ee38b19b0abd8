"""Effect: thermal growth of the wave generator."""

from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.frozen import ScaledDisplacement
from swgsim.effects.quantity import size
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint


@dataclass(frozen=True)
class ThermalGrowth(Effect):
    """The wave generator grows against the flex spline as the gear warms: displacement (1 + share dT).

    Signature: orders 2 and 4 of the deflection, alike in opposite gauges, change with temperature, without regard to
    load or speed. Typical: 1.2e-3 per K if the wave generator alone warms (11.5e-6 / K of 21.6 mm over 0.216 mm;
    physics.md FS22), next to nothing if both warm alike, negative if the flex spline is the warmer one.

    Attributes
    ----------
    share : float
        Of the deflection per kelvin above the reference temperature [1/K], up to 3e-3 either way.
    """

    place = "wave generator"
    share: float = size(unit="1/K", low=-3e-3, high=3e-3, typical=1.2e-3)

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The deflection at the temperature of the recording."""
        return ScaledDisplacement(1 + self.share * conditions.warmer)
