"""Fault: eccentric wave generator."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.quantity import phase, size


@dataclass(frozen=True)
class EccentricWaveGenerator(Effect):
    """The axis of the wave generator is off centre by u_ecc = [r, theta, 0] (section II-B), fixed to the flex spline.

    Signature: opposite offsets of opposite gauges, a pattern of one wave around the collar, and changed even orders
    under load, because the lobe that sinks deeper carries more of it; no odd orders, as the two lobes are alike.
    Typical: 0.02 to 0.15 mm; assembly tolerances allow 0.010 to 0.034 mm.

    Attributes
    ----------
    r : float
        Eccentricity [m], from 0 to 0.15 mm; beyond, the teeth of one lobe would leave engagement.
    theta : float
        Its direction [rad].
    """

    place = "wave generator"
    r: float = size(unit="m", low=0, high=0.15e-3, typical=0.05e-3)
    theta: float = phase()

    def wave_generator(
        self,
        displacement: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """The displacement plus the radial part of the shift."""
        return displacement + self.r * np.cos(theta - self.theta)
