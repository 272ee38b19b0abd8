"""Imperfection: a gauge is bonded at the wrong direction."""

from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.one_gauge import with_gauge
from swgsim.effects.quantity import choice, size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class GaugeDirection(Effect):
    """The +-45 degree grids of one bridge are turned by an angle: cos 2 angle of the shear, and sin 2 angle of the
    difference of radial and hoop strain (physics.md SE2).

    Signature: order 2 of this gauge in quadrature, 7.8 % of it per degree, since these strains are largest where the
    shear is zero; the mean, which is the torque's shear, falls by cos 2 angle only. On s1 to s4 it is hard to tell from
    a wrong position of -2.2 times the angle: order 4 alone differs. It also stands for grids of a pair that differ in
    transverse sensitivity (SE12), which lets radial and hoop strain in as well; alike in both grids, it is a gain.
    Typical: 1 degree.

    Attributes
    ----------
    sensor : int
    angle : float
        [rad], up to 0.17 (10 degrees; a larger error is seen by eye) both ways.
    """

    place = "gear"
    sensor: int = choice(low=0, high=4)
    angle: float = size(unit="rad", low=-0.17, high=0.17, typical=0.017)

    def gear(self, gear: Gear) -> Gear:
        """The gear with the gauge turned on its spot."""
        return with_gauge(gear, self.sensor, grid_angle=gear.gauges.grid_angle[self.sensor] + self.angle)
