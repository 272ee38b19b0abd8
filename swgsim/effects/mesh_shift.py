from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Field, Psi, Theta
from swgsim.effects.frozen import turned
from swgsim.effects.quantity import size


@dataclass(frozen=True)
class MeshShift(Effect):
    """The tooth force is centred ahead of the lobes by an angle, by asymmetric flanks or a twisted engagement.

    The shares of the tooth force turn ahead at any load, the deflection does not (second part of physics.md FS7).
    Damaged teeth that are listed before this effect turn too.

    Signature: order k of the contribution of the teeth changes by the phase k angle, equally in opposite gauges, so the
    change grows in proportion to load. Typical: 1 to 5 degrees (estimate).

    Attributes
    ----------
    angle : float
        [rad], from -0.3 to 0.3.
    """

    place = "mesh"
    angle: float = size(unit="rad", low=-0.3, high=0.3, typical=0.05)

    def mesh(self, share: Field, psi: Psi, theta: Theta) -> Field:
        """The shares at angles further back; teeth only push, so the series' ripple below zero is taken off."""
        return np.maximum(turned(share, self.angle), 0)
