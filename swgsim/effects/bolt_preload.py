"""Imperfection: preload of the collar's bolts."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import size
from swgsim.flexspline.gauges import waves


@dataclass(frozen=True)
class BoltPreload(Effect):
    """Bolts tightened unequally, or a seat that is not flat, leave a static field of two waves around the collar, as
    when bolts are tightened crosswise (physics.md SE18). At four gauges it has one number, whatever its direction; one
    wave and three waves are the tilting moment.

    Signature: equal means of opposite gauges, opposite ones of neighbours, at all loads and speeds; s0 and the orders
    stay. Changes when the gear is assembled anew. Typical: 5 to 50 um/m, 0.0025 to 0.025 mV/V.

    Attributes
    ----------
    strain : float
        On s1 and s3 [mV/V], up to 0.1 (200 um/m; beyond, the collar is bent) both ways.
    """

    place = "gauge"
    strain: float = size(unit="mV/V", low=-0.1, high=0.1, typical=0.01)

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals with the offsets of two waves around the collar."""
        return signals + self.strain * waves(2).real
