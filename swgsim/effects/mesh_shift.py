"""Imperfection: shifted mesh."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.frozen import turned
from swgsim.effects.quantity import size


@dataclass(frozen=True)
class MeshShift(Effect):
    """The force of the teeth is centred beside the lobes: asymmetric flanks or a twisted engagement.

    The shares are turned ahead by an angle whatever the load, the deflection is not (second part of physics.md FS7);
    teeth that are listed as damaged before are turned along. Signature: order k of what the teeth contribute changes
    by the phase k angle, alike in opposite gauges, so that the change grows in proportion to load. Typical: 1 to 5
    degrees (estimate).

    Attributes
    ----------
    angle : float
        [rad], up to 0.3 either way.
    """

    place = "mesh"
    angle: float = size(unit="rad", low=-0.3, high=0.3, typical=0.05)

    def mesh(
        self,
        share: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """The shares at angles further back; teeth only push, so the series' ripple below zero is taken off."""
        return np.maximum(turned(share, self.angle), 0)
