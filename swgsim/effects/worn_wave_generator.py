"""Ageing: worn wave generator."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size


@dataclass(frozen=True)
class WornWaveGenerator(Effect):
    """Wear between wave generator and sleeve takes a share of the deflection (physics.md AG4).

    Signature: orders 2 and 4 of the deflection fall, alike in opposite gauges, without regard to load, speed or
    temperature. It is the same as a smaller w0 of the gear, so a gear whose w0 is calibrated cannot show it. Typical: 2
    % (estimate).

    Attributes
    ----------
    loss : float
        Share of w0 that is lost, from 0 to 0.3.
    """

    place = "wave generator"
    loss: float = size(unit="-", low=0, high=0.3, typical=0.02)

    def wave_generator(
        self,
        displacement: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """What is left of the displacement."""
        return displacement * (1 - self.loss)
