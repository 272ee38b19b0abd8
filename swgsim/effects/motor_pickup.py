from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Channels, Effect, Scene
from swgsim.effects.quantity import choice, phase, size
from swgsim.effects.turns import on_gauges


@dataclass(frozen=True)
class MotorPickup(Effect):
    """The field of the motor, with p pole pairs, couples into all bridges: amplitude cos(p phi_in + phase).

    The source is physics.md SE20.

    Signature: order p, odd or even, equally and in phase in all gauges, s0 too, at all loads and speeds. Typical: 0.1
    to 1 % of order 2, 0.0002 to 0.002 mV/V; 4 to 10 pole pairs.

    Attributes
    ----------
    p : int
        Pairs of poles, from 3 to 10.
    amplitude : float
        [mV/V], from 0 to 0.05 (a quarter of order 2; beyond, a shield is open).
    phase : float
        Of the wave at phi_in = 0, the major axis at s1 [rad].
    """

    place = "acquisition"
    p: int = choice(low=3, high=10)
    amplitude: float = size(unit="mV/V", low=0, high=0.05, typical=5e-4)
    phase: float = phase()

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with pick-up on the gauges."""
        pickup = self.amplitude * np.cos(self.p * scene.phi_in + self.phase)
        return on_gauges(channels, lambda _, signal: signal + pickup)
