from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.one_gauge import with_gauge
from swgsim.effects.quantity import choice, size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class GaugePosition(Effect):
    """The grids of one bridge are bonded further around the collar, at beta_i + shift (physics.md SE1).

    Signature: order n of this gauge lags by n times the shift, at all loads and speeds. In the difference of opposite
    gauges n shift A_n of the even orders appears, mainly order 2. The torque ripple, which all angles feel at once,
    does not lag. Typical: 0.1 to 1 degree, 0.05 to 0.5 mm.

    Attributes
    ----------
    sensor : int
        Number of the gauge, from 0 to 4.
    shift : float
        [rad], from -0.1 to 0.1 (2.8 mm on the default collar; beyond, the grid has left its pad).
    """

    place = "gear"
    sensor: int = choice(low=0, high=4)
    shift: float = size(unit="rad", low=-0.1, high=0.1, typical=0.009)

    def gear(self, gear: Gear) -> Gear:
        """The gear with the gauge moved on."""
        return with_gauge(gear, self.sensor, position=gear.gauges.position[self.sensor] + self.shift)
