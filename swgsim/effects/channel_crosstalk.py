"""Imperfection: crosstalk between neighbouring channels."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import choice, size
from swgsim.effects.turns import on_gauges
from swgsim.storage.labelled_signals import SENSORS


@dataclass(frozen=True)
class ChannelCrosstalk(Effect):
    """A share of the next channel (s0 after s4) appears in one channel: a ground loop, a common return wire, or a
    multiplexer that has not settled. An estimate; physics.md SE20 names ground loops.

    Signature: neighbours among s1 to s4 have order 2 in opposite phase and the same mean, so order 2 of this gauge
    falls by the share and its mean rises by the share; s0 gets order 2 from s1, and s4 the mean of s0 only.
    Typical: 0.5 %.

    Attributes
    ----------
    sensor : int
    share : float
        Up to 0.1 (beyond, the wiring is wrong) both ways.
    """

    place = "acquisition"
    sensor: int = choice(low=0, high=4)
    share: float = size(unit="-", low=-0.1, high=0.1, typical=0.005)

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels with one of them mixed."""
        neighbour = channels[SENSORS[(self.sensor + 1) % len(SENSORS)]]
        return on_gauges(channels, lambda s, signal: signal + self.share * neighbour if s == self.sensor else signal)
