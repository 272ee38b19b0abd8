"""Imperfection: out-of-round flex spline."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class OutOfRound(Effect):
    """The flex spline is not round when free, or its housing is not: w cos(n theta - phase), fixed to it.

    From heat treatment, residual stress or clamping (physics.md FS14). Signature: offsets without load, for n = 2 alike
    in opposite gauges and opposite in neighbours, for n = 3 opposite in opposite gauges, for n = 4 alike in all; under
    load even orders, as teeth engage more deeply where it bulges. Typical: 5 to 30 um (estimate).

    Attributes
    ----------
    n : int
        Lobes, from 2 to 4; one is an eccentric wave generator.
    amplitude : float
        w [m], from 0 to 60 um.
    phase : float
        It bulges at phase / n [rad].
    """

    place = "wave generator"
    n: int = choice(low=2, high=4)
    amplitude: float = size(unit="m", low=0, high=60e-6, typical=10e-6)
    phase: float = phase()

    def wave_generator(
        self,
        displacement: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """The displacement plus the bulges."""
        return displacement + self.amplitude * np.cos(self.n * theta - self.phase)
