from dataclasses import dataclass

from swgsim.effects.base import Channels, Effect, Scene
from swgsim.effects.quantity import choice, size
from swgsim.effects.turns import on_gauges
from swgsim.storage.labelled_signals import SENSORS


@dataclass(frozen=True)
class ChannelCrosstalk(Effect):
    """A share of the next channel appears in one channel; s0 follows s4.

    Causes are a ground loop, a common return wire, or a multiplexer that has not settled. The size is an estimate;
    physics.md SE20 names ground loops.

    Signature: neighbours among s1 to s4 have order 2 in opposite phase and equal means. Order 2 of this gauge therefore
    falls by the share, and its mean rises by the share. In s0 order 2 of s1 appears; s4 gains the mean of s0 only.
    Typical: 0.5 %.

    Attributes
    ----------
    sensor : int
        Number of the gauge, from 0 to 4.
    share : float
        From -0.1 to 0.1 (beyond, the wiring is wrong).
    """

    place = "acquisition"
    sensor: int = choice(low=0, high=4)
    share: float = size(unit="-", low=-0.1, high=0.1, typical=0.005)

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with one of them mixed."""
        neighbour = channels[SENSORS[(self.sensor + 1) % len(SENSORS)]]
        return on_gauges(channels, lambda s, signal: signal + self.share * neighbour if s == self.sensor else signal)
