from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Field, Psi, Theta
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class OutOfRound(Effect):
    """The free flex spline or its housing is not round: a displacement amplitude cos(n theta - phase), fixed to it.

    Causes are heat treatment, residual stress or clamping (physics.md FS14).

    Signature: offsets without load. For n = 2 they are equal in opposite gauges and opposite in neighbours, for n = 3
    opposite in opposite gauges, for n = 4 equal in all. Under load even orders appear, as teeth engage deeper at the
    bulges. Typical: 5 to 30 um (estimate).

    Attributes
    ----------
    n : int
        Lobes, from 2 to 4; one is an eccentric wave generator.
    amplitude : float
        w [m], from 0 to 60 um.
    phase : float
        The sleeve bulges at phase / n, from gauge s1 [rad].
    """

    place = "wave generator"
    n: int = choice(low=2, high=4)
    amplitude: float = size(unit="m", low=0, high=60e-6, typical=10e-6)
    phase: float = phase()

    def wave_generator(self, displacement: Field, psi: Psi, theta: Theta) -> Field:
        """The displacement plus the bulges."""
        return displacement + self.amplitude * np.cos(self.n * theta - self.phase)
