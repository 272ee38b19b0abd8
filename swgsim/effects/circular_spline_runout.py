from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Field, Psi, Theta
from swgsim.effects.quantity import choice, random_phase, size


@dataclass(frozen=True)
class CircularSplineRunout(Effect):
    """The circular spline is off centre (n = 1) or oval (n = 2): tooth forces vary by 1 + e cos(n theta - phase).

    It turns with the output, so its direction differs in every recording (physics.md FS21, circular spline of FS9). The
    model neglects that it turns within a recording, by 1 / (N + 1) of a revolution for each of the wave generator: 43
    degrees in 12 revolutions of the default gear.

    Signature: even orders including 0, in proportion to load, with a phase that does not repeat. They are opposite in
    opposite gauges for n = 1 and equal for n = 2. Typical: 5 to 20 um of 216 um depth of engagement (estimate).

    Attributes
    ----------
    n : int
        1 or 2.
    e : float
        Share of the tooth force, from 0 to 0.5.
    phase : float
        The force is largest at phase / n, from gauge s1 [rad].
    """

    place = "mesh"
    n: int = choice(low=1, high=2)
    e: float = size(unit="-", low=0, high=0.5, typical=0.05)
    phase: float = random_phase()

    def mesh(self, share: Field, psi: Psi, theta: Theta) -> Field:
        """The shares with the wave on them."""
        return share * (1 + self.e * np.cos(self.n * theta - self.phase))
