from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Field, Psi, Theta
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class UnevenTeeth(Effect):
    """Errors of pitch and profile, fixed to the flex spline, scale the tooth force by 1 + e cos(k theta - phase).

    The source is physics.md FS9. This is one wave of the error; real teeth have many, and an error of fixed depth
    matters less at a higher load.

    Signature: even orders including 0, in proportion to load, with k - n and k + n waves at order n. They are opposite
    in opposite gauges for odd k and equal for even k. Long waves reach the collar, short ones hardly. Typical: the
    force scatters by 5 to 20 % from tooth to tooth; one wave has a part of this.

    Attributes
    ----------
    k : int
        Waves around the circumference, from 3 to 10.
    e : float
        Share of the tooth force, from 0 to 0.5.
    phase : float
        The force is largest at phase / k, from gauge s1 [rad].
    """

    place = "mesh"
    k: int = choice(low=3, high=10)
    e: float = size(unit="-", low=0, high=0.5, typical=0.05)
    phase: float = phase()

    def mesh(self, share: Field, psi: Psi, theta: Theta) -> Field:
        """The shares with the wave on them."""
        return share * (1 + self.e * np.cos(self.k * theta - self.phase))
