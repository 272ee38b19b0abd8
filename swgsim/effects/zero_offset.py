from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.one_gauge import with_gauge
from swgsim.effects.quantity import choice, size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class ZeroOffset(Effect):
    """One bridge is out of balance after bonding and assembly, so its zero is off (physics.md SE4).

    Signature: the mean of this gauge, at all loads and speeds. In opposite pairs of s1 to s4 it looks like a tilting
    moment or, without load, like an eccentric wave generator. Typical: 0.01 to 0.05 mV/V if not calibrated.

    Attributes
    ----------
    sensor : int
        Number of the gauge, from 0 to 4.
    offset : float
        [mV/V], from -1 to 1; a bridge further out fails the check after bonding.
    """

    place = "gear"
    sensor: int = choice(low=0, high=4)
    offset: float = size(unit="mV/V", low=-1, high=1, typical=0.02)

    def gear(self, gear: Gear) -> Gear:
        """The gear with the zero of one bridge moved."""
        return with_gauge(gear, self.sensor, offset=gear.gauges.offset[self.sensor] + self.offset)
