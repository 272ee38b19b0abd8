from dataclasses import dataclass, replace

import numpy as np

from swgsim.effects.base import Channels, Effect, Scene
from swgsim.effects.one_gauge import ALL, weights
from swgsim.effects.quantity import choice, choice_among, random_phase, shape, size
from swgsim.effects.turns import on_gauges


@dataclass(frozen=True)
class MainsHum(Effect):
    """The mains or one of its harmonics couples into all bridges equally, or into the cable of one (physics.md SE20).

    Signals gain amplitude cos(2 pi frequency t + phase). The cables of several gauges may hum differently, and at
    several harmonics.

    Signature: a line at a fixed frequency, so at another order at every speed, in all gauges or in one. Its phase
    differs in every recording and does not depend on load. Typical: 0.1 to 1 % of order 2, 0.0002 to 0.002 mV/V.

    Attributes
    ----------
    amplitude : float
        [mV/V], from 0 to 0.05 (a quarter of order 2; beyond, a cable is broken).
    frequency : float
        [Hz], one of the first three multiples of 50 and of 60 Hz, or of their fifth and sixth, as a rectifier makes.
    phase : float
        At the trigger [rad].
    sensor : int
        Number of the gauge, from 0 to 4; 5 for all of them.
    deviation : float
        Share by which the grid is faster, from -0.004 to 0.004, what large grids allow themselves.
    """

    place = "acquisition"
    amplitude: float = size(unit="mV/V", low=0, high=0.05, typical=5e-4)
    frequency: float = choice_among(50, 60, 100, 120, 150, 180, 250, 300, 360, unit="Hz")
    phase: float = random_phase()
    sensor: int = choice(ALL, low=0, high=ALL)
    deviation: float = shape(0.0, unit="-", low=-0.004, high=0.004, points=3)

    def parts(self) -> tuple[Effect, ...]:
        """The hum of each gauge."""
        return tuple(replace(self, sensor=s) for s in range(ALL))

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with hum on the gauges."""
        frequency = self.frequency * (1 + self.deviation)
        hum = self.amplitude * np.cos(2 * np.pi * frequency * scene.time + self.phase)
        felt = weights(self.sensor)[:, 0]
        return on_gauges(channels, lambda s, signal: signal + felt[s] * hum)
