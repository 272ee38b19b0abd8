from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.frozen import FULL_SPEED, ScaledDisplacement
from swgsim.effects.quantity import size
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint


@dataclass(frozen=True)
class SpeedDeformation(Effect):
    """Inertia of the rim under the travelling wave scales the displacement by 1 + share (n / 4000 rpm)^2.

    The source is physics.md FS16. Shell modes far above the orders of the deflection act by the same law (FS15).

    Signature: orders 2 and 4 of the deflection change with the square of speed, equally in opposite gauges and at any
    load. Typical: below 1e-3 at 4000 rpm (estimate).

    Attributes
    ----------
    share : float
        Of the deflection at 4000 rpm, from -0.02 to 0.02.
    """

    place = "wave generator"
    share: float = size(unit="-", low=-0.02, high=0.02, typical=1e-3)

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The deflection at the speed."""
        return ScaledDisplacement(1 + self.share * (point.n_in_rpm / FULL_SPEED) ** 2)
