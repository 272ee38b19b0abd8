from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.frozen import ScaledDisplacement
from swgsim.effects.quantity import size
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint


@dataclass(frozen=True)
class ThermalGrowth(Effect):
    """The warming wave generator grows against the flex spline: the displacement scales by 1 + share dT.

    Signature: orders 2 and 4 of the deflection change with temperature, equally in opposite gauges and at any load and
    speed. Typical: 1.2e-3 per K if only the wave generator warms (11.5e-6 / K of 21.6 mm over 0.216 mm; physics.md
    FS22). It is nearly 0 if both warm alike, and negative if the flex spline is warmer.

    Attributes
    ----------
    share : float
        Of the deflection per kelvin above the reference temperature [1/K], from -3e-3 to 3e-3.
    """

    place = "wave generator"
    share: float = size(unit="1/K", low=-3e-3, high=3e-3, typical=1.2e-3)

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The deflection at the temperature of the recording."""
        return ScaledDisplacement(1 + self.share * conditions.warmer)
