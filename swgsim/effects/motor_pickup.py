"""Disturbance: pick-up from the motor."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import choice, phase, size
from swgsim.effects.turns import on_gauges


@dataclass(frozen=True)
class MotorPickup(Effect):
    """The motor's field, which turns p times per revolution, couples into all bridges alike (physics.md SE20).

    Signature: order p, odd ones as well, alike and in phase in all gauges, s0 too, at all loads and speeds.
    Typical: 0.1 to 1 % of order 2, 0.0002 to 0.002 mV/V; 4 to 10 pole pairs.

    Attributes
    ----------
    p : int
        Pairs of poles, from 3 to 10.
    amplitude : float
        [mV/V], from 0 to 0.05 (a quarter of order 2; beyond, a shield is open).
    phase : float
        [rad].
    """

    place = "acquisition"
    p: int = choice(low=3, high=10)
    amplitude: float = size(unit="mV/V", low=0, high=0.05, typical=5e-4)
    phase: float = phase()

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels with pick-up on the gauges."""
        pickup = self.amplitude * np.cos(self.p * scene.phi_in + self.phase)
        return on_gauges(channels, lambda _, signal: signal + pickup)
