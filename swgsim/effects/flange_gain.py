from dataclasses import dataclass

from swgsim.effects.base import Channels, Effect, Scene
from swgsim.effects.quantity import choice, size


@dataclass(frozen=True)
class FlangeGain(Effect):
    """The torque flange at the output, or at the input, shows 1 + share of the torque (physics.md DY14).

    Signature: the channel T_out or T_in, and so the efficiency, changes by one share at every load. The gauges do not
    change, so their sensitivity to the shown T_out seems to be another one. Typical: 0.1 to 0.2 %.

    Attributes
    ----------
    share : float
        From -0.05 to 0.05 (beyond, the flange is not calibrated).
    at_input : int
        1 for the flange at the input, 0 for that at the output.
    """

    place = "acquisition"
    share: float = size(unit="-", low=-0.05, high=0.05, typical=0.002)
    at_input: int = choice(0, low=0, high=1)

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with one torque scaled."""
        name = "T_in" if self.at_input else "T_out"
        return {**channels, name: channels[name] * (1 + self.share)}
