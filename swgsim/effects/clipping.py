from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Channels, Effect, Scene
from swgsim.effects.quantity import size
from swgsim.effects.turns import on_gauges


@dataclass(frozen=True)
class Clipping(Effect):
    """The amplifiers saturate: no gauge shows more than a level, positive or negative (physics.md AC9).

    Signature: flat peaks beyond some load. The torque raises the mean, so the upper peaks are cut first: mean and order
    2 of s1 to s4 fall, and order 4 appears. Typical: 0.25 mV/V, a little below the peaks at 70 N m.

    Attributes
    ----------
    level : float
        [mV/V], from 0.01 (little of the signal is left) to 10 (nothing is cut).
    """

    place = "acquisition"
    sharp = True
    level: float = size(unit="mV/V", low=0.01, high=10, typical=0.25, nothing=10, further=(0.2, 0.15, 0.1), scale=0.1)

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with the gauges cut."""
        return on_gauges(channels, lambda _, signal: np.clip(signal, -self.level, self.level))
