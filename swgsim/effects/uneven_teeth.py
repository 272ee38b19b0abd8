"""Imperfection: uneven teeth of the flex spline."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class UnevenTeeth(Effect):
    """Errors of pitch and profile, fixed to the flex spline: share (1 + e cos(k theta - phase)) (physics.md FS9).

    One wave of the error around the circumference; real teeth have many, and an error of fixed depth would matter less
    the higher the load. Signature: even orders from 0 on, in proportion to load, in patterns of k - n and k + n waves
    at order n: opposite in opposite gauges for odd k, alike for even k. Long waves reach the collar, short ones hardly.
    Typical: force scatters by 5 to 20 % from tooth to tooth, of which one wave has a part.

    Attributes
    ----------
    k : int
        Waves around the circumference, from 3 to 10.
    e : float
        Share of the tooth force, from 0 to 0.5.
    phase : float
        The force is largest at phase / k [rad].
    """

    place = "mesh"
    k: int = choice(low=3, high=10)
    e: float = size(unit="-", low=0, high=0.5, typical=0.05)
    phase: float = phase()

    def mesh(
        self,
        share: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """The shares with the wave on them."""
        return share * (1 + self.e * np.cos(self.k * theta - self.phase))
