"""Imperfection or damage: a gauge shows too much or too little."""

from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.one_gauge import with_gauge
from swgsim.effects.quantity import choice, size
from swgsim.gear import Gear


@dataclass(frozen=True)
class GaugeGain(Effect):
    """The strain of one bridge counts 1 + share (physics.md SE3); its zero stays.

    Signature: mean and all orders of this gauge alike, at all loads and speeds. It also stands for a bond that comes
    off, which is a loss up to all of the signal (SE15), for a radius that is off (SE2), for lead wires (SE13) and for
    transverse sensitivity (SE12). Typical: 0.3 to 1 %, the tolerance of gauge factors.

    Attributes
    ----------
    sensor : int
    share : float
        From -1 (the gauge is off) to 0.5 (beyond, another gauge or amplifier setting, not an error).
    """

    place = "gear"
    sensor: int = choice(low=0, high=4)
    share: float = size(unit="-", low=-1, high=0.5, typical=0.005)

    def gear(self, gear: Gear) -> Gear:
        """The gear with the gain of one bridge scaled."""
        return with_gauge(gear, self.sensor, gain=gear.gauges.gain[self.sensor] * (1 + self.share))
