from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Field, Psi, Theta
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class UnevenSleeve(Effect):
    """The wall of the sleeve is thicker at some places: the displacement scales by 1 + e cos(k theta - phase).

    This approximates physics.md FS13: a thicker wall passes more of the deflection on to the collar and engages deeper.
    The stiffness of the truss stays even.

    Signature: order 2, because an unevenness that is fixed to the flex spline adds waves around it (2 - k and 2 + k),
    not orders in time. For k = 1 opposite gauges change in opposite ways, as with a wave generator that is tilted about
    its middle. For k = 2 s1 to s4 change alike and s0 twice as much. Under load orders 0 and 4 change slightly.
    Typical: 1 to 3 % of the wall.

    Attributes
    ----------
    k : int
        1, thicker on one side, or 2, thicker on two.
    e : float
        Share of the deflection, from 0 to 0.2.
    phase : float
        The wall is thickest at phase / k, from gauge s1 [rad].
    """

    place = "wave generator"
    k: int = choice(low=1, high=2)
    e: float = size(unit="-", low=0, high=0.2, typical=0.02)
    phase: float = phase()

    def wave_generator(self, displacement: Field, psi: Psi, theta: Theta) -> Field:
        """The displacement with the wave on it."""
        return displacement * (1 + self.e * np.cos(self.k * theta - self.phase))
