"""Imperfection: runout or ovality of the circular spline."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.quantity import choice, random_phase, size


@dataclass(frozen=True)
class CircularSplineRunout(Effect):
    """The circular spline is off centre (n = 1) or oval (n = 2): share (1 + e cos(n theta - phase)).

    It turns with the output, so its direction is another one in every recording (physics.md FS21, circular spline of
    FS9). Neglected: within a recording it turns on by 1 / (N + 1) of a revolution for each of the wave generator, 43
    degrees in 12 revolutions of the default gear. Signature: even orders from 0 on in proportion to load, for n = 1
    opposite in opposite gauges, for n = 2 alike, with a phase that does not repeat. Typical: 5 to 20 um of 216 um depth
    of engagement (estimate).

    Attributes
    ----------
    n : int
        1 or 2.
    e : float
        Share of the tooth force, from 0 to 0.5.
    phase : float
        The force is largest at phase / n [rad].
    """

    place = "mesh"
    n: int = choice(low=1, high=2)
    e: float = size(unit="-", low=0, high=0.5, typical=0.05)
    phase: float = random_phase()

    def mesh(
        self,
        share: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """The shares with the wave on them."""
        return share * (1 + self.e * np.cos(self.n * theta - self.phase))
