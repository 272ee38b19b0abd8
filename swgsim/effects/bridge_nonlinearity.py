"""Imperfection: bridges and amplifiers that are not linear."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.one_gauge import ALL, weights
from swgsim.effects.quantity import choice, size

# Signal at which a cubic one has the size of a square one [mV/V], that of a gauge at full load.
FULL = 0.25


@dataclass(frozen=True)
class BridgeNonlinearity(Effect):
    """A signal s shows as s + share s^2, in all bridges or in one (physics.md SE10). A bridge whose opposite grids
    strain equally is linear, so this is what unequal grids and the amplifier leave. Where both signs bend alike it goes
    with the cube, s + share s^3 / 0.25 mV/V.

    Signature: order 4 and the mean of s1 to s4 by half of share A_2^2, at any load; order 2 by twice share times mean,
    in proportion to the load; s0 nearly its mean only, by load squared. The cube adds order 6. Typical: 2e-3 per mV/V,
    a quarter bridge.

    Attributes
    ----------
    share : float
        [1/(mV/V)], up to 0.2 (of an amplifier out of order) both ways.
    sensor : int
        From 0 to 4; 5: all of them.
    power : int
        2 or 3.
    """

    place = "gauge"
    share: float = size(unit="1/(mV/V)", low=-0.2, high=0.2, typical=2e-3)
    sensor: int = choice(ALL, low=0, high=ALL)
    power: int = choice(2, low=2, high=3)

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals, bent."""
        return signals + self.share * weights(self.sensor) * signals**2 * (signals / FULL) ** (self.power - 2)
