from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.one_gauge import with_gauge
from swgsim.effects.quantity import choice, size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class GaugeDirection(Effect):
    """The +-45 degree grids of one bridge are turned by an angle.

    The bridge then shows cos(2 angle) of the shear and sin(2 angle) of the difference of radial and hoop strain
    (physics.md SE2). The effect also stands for grids of a pair with different transverse sensitivity (SE12); equal
    transverse sensitivity of both grids is a gain error.

    Signature: order 2 of this gauge in quadrature, 7.8 % of it per degree, because these strains are largest where the
    shear is zero. The mean falls by cos(2 angle) only. On s1 to s4 a wrong position of -2.2 times the angle looks
    nearly the same; only order 4 differs. Typical: 1 degree.

    Attributes
    ----------
    sensor : int
        Number of the gauge, from 0 to 4.
    angle : float
        [rad], from -0.17 to 0.17 (10 degrees; a larger error is seen by eye).
    """

    place = "gear"
    sensor: int = choice(low=0, high=4)
    angle: float = size(unit="rad", low=-0.17, high=0.17, typical=0.017)

    def gear(self, gear: Gear) -> Gear:
        """The gear with the gauge turned on its spot."""
        return with_gauge(gear, self.sensor, grid_angle=gear.gauges.grid_angle[self.sensor] + self.angle)
