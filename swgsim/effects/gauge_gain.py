from dataclasses import dataclass, replace

from swgsim.effects.base import Effect
from swgsim.effects.one_gauge import ALL, weights
from swgsim.effects.quantity import choice, size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class GaugeGain(Effect):
    """The strain of one bridge, or of all, counts 1 + share (physics.md SE3); zeros stay.

    For all gauges this is another excitation, or an amplifier that was set again between sessions (AC9). For one gauge
    it also stands for a lost bond, up to the whole signal (SE15), a wrong radius (SE2), lead wires (SE13) and
    transverse sensitivity (SE12).

    Signature: mean and all orders of this gauge change by one share, at all loads and speeds. Typical: 0.3 to 1 %, the
    tolerance of gauge factors.

    Attributes
    ----------
    sensor : int
        Number of the gauge, from 0 to 4; 5 for all of them.
    share : float
        From -1 (the gauge is off) to 0.5 (beyond, another gauge or amplifier setting, not an error).
    """

    place = "gear"
    sensor: int = choice(low=0, high=ALL)
    share: float = size(unit="-", low=-1, high=0.5, typical=0.005)

    def gear(self, gear: Gear) -> Gear:
        """The gear with gains scaled."""
        factors = 1 + self.share * weights(self.sensor)[:, 0]
        gain = tuple(g * factor for g, factor in zip(gear.gauges.gain, factors.tolist(), strict=True))
        return replace(gear, gauges=replace(gear.gauges, gain=gain))
