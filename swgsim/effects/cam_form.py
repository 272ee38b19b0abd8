from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Field, Psi, Theta
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class CamForm(Effect):
    """The cam of the wave generator has a form error of n lobes, w_n cos(n (theta - psi) + phase), that turns with it.

    The source is physics.md FS2; psi is the angle of the major axis from s1.

    Signature: order n in all gauges; odd n shows in the differences of opposite gauges. Typical: 1 to 4 um at n = 3, 5.

    Attributes
    ----------
    n : int
        Number of lobes, from 3 to 8; one lobe is an eccentricity, two are the ellipse.
    amplitude : float
        w_n [m], from 0 to 20 um.
    phase : float
        Of the wave at phi_in = 0, the major axis at s1 [rad].
    """

    place = "wave generator"
    n: int = choice(low=3, high=8)
    amplitude: float = size(unit="m", low=0, high=20e-6, typical=2e-6)
    phase: float = phase()

    def wave_generator(self, displacement: Field, psi: Psi, theta: Theta) -> Field:
        """The displacement plus the lobing."""
        return displacement + self.amplitude * np.cos(self.n * (theta - psi[:, None]) + self.phase)
