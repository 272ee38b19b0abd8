from dataclasses import dataclass

from swgsim.effects.base import Channels, Effect, Scene
from swgsim.effects.quantity import size


@dataclass(frozen=True)
class FlangeZero(Effect):
    """The torque flange at the input has a zero error: it shows a constant torque in addition (physics.md DY14).

    Signature: the mean of T_in, and so the efficiency, mostly at small loads (at 7 N m the input takes 0.15 N m). It
    resembles friction but is equal at all speeds; the gauges do not change. Typical: 5 mN m, 0.1 to 0.2 % of a flange
    for a few N m.

    Attributes
    ----------
    zero : float
        [N m], from -0.1 to 0.1; beyond, the efficiency at small loads would pass 1.
    """

    place = "acquisition"
    zero: float = size(unit="N m", low=-0.1, high=0.1, typical=0.005)

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with the input torque moved."""
        return {**channels, "T_in": channels["T_in"] + self.zero}
