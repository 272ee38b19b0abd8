"""Imperfection: bridges and amplifiers that are not linear."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import size


@dataclass(frozen=True)
class BridgeNonlinearity(Effect):
    """A signal s shows as s + share s^2, in all bridges (physics.md SE10). A bridge whose opposite grids strain equally
    is linear, so this is what unequal grids and the amplifier leave.

    Signature: order 4 and the mean of s1 to s4 by half of share A_2^2, at any load; order 2 by twice share times mean,
    in proportion to the load; s0 nearly its mean only, by load squared. Typical: 2e-3 per mV/V, a quarter bridge.

    Attributes
    ----------
    share : float
        [1/(mV/V)], up to 0.1 (of an amplifier out of order) both ways.
    """

    place = "gauge"
    share: float = size(unit="1/(mV/V)", low=-0.1, high=0.1, typical=2e-3)

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals, bent."""
        return signals + self.share * signals**2
