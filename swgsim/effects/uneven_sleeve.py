"""Imperfection: uneven wall of the sleeve."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class UnevenSleeve(Effect):
    """The thickness of the wall varies around the circumference: displacement (1 + e cos(k theta - phase)).

    An approximation of physics.md FS13: a thicker wall passes more of the deflection on to the collar and engages
    deeper; its stiffness stays even. Signature: order 2 again, not 2 +- k: what is fixed to the flex spline adds waves
    around it, here 2 - k and 2 + k of them, not orders in time. For k = 1 opposite gauges change in opposite ways, as
    with a wave generator tilted about its middle; for k = 2 s1 to s4 change alike and s0 twice as much. Under load a
    little at orders 0 and 4. Typical: 1 to 3 % of the wall.

    Attributes
    ----------
    k : int
        1, thicker on one side, or 2, thicker on two.
    e : float
        Share of the deflection, from 0 to 0.2.
    phase : float
        The wall is thickest at phase / k [rad].
    """

    place = "wave generator"
    k: int = choice(low=1, high=2)
    e: float = size(unit="-", low=0, high=0.2, typical=0.02)
    phase: float = phase()

    def wave_generator(
        self,
        displacement: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """The displacement with the wave on it."""
        return displacement * (1 + self.e * np.cos(self.k * theta - self.phase))
