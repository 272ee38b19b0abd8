"""Imperfection: apparent strain of one gauge, or of all, with temperature."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.one_gauge import ALL, weights
from swgsim.effects.quantity import choice, size


@dataclass(frozen=True)
class ThermalOutput(Effect):
    """The grids of one bridge, or of all alike, expand unequally: its zero moves by slope dT (physics.md SE5; linear
    near 25 degC).

    Signature: the mean of this gauge, or of all, in proportion to the temperature, whatever load and speed. Typical:
    0.1 to 1 um/m per K of mismatch, 0.5e-3 mV/V per um/m of a pair.

    Attributes
    ----------
    sensor : int
        From 0 to 4; 5: all of them.
    slope : float
        [mV/V per K], up to 5e-3 (10 um/m per K, bare foil on the wrong material) both ways.
    """

    place = "gauge"
    sensor: int = choice(low=0, high=ALL)
    slope: float = size(unit="mV/V per K", low=-5e-3, high=5e-3, typical=2.5e-4)

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals with zeros moved."""
        return signals + self.slope * scene.conditions.warmer * weights(self.sensor)
