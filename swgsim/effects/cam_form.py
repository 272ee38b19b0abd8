"""Imperfection: form error of the wave generator's cam."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.checks import require, require_integer
from swgsim.effects.base import Effect


@dataclass(frozen=True)
class CamForm(Effect):
    """Lobing of the cam, w_n cos n (theta - psi) + phase, that turns with the wave generator (physics.md FS2).

    Signature: order n in all gauges; odd n shows in the differences of opposite gauges. Typical: 1 to 4 um at n = 3, 5.

    Attributes
    ----------
    n : int
        Number of lobes, from 1 to 12.
    amplitude : float
        w_n [m], from 0 to 20 um.
    phase : float
        [rad].
    """

    n: int
    amplitude: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        require_integer("the cam form", "n", self.n, low=1, high=12)
        require("the cam form", "amplitude", self.amplitude, low=0, high=20e-6)
        require("the cam form", "phase", self.phase)

    def wave_generator(
        self,
        displacement: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """The displacement plus the lobing."""
        return displacement + self.amplitude * np.cos(self.n * (theta - psi[:, None]) + self.phase)
