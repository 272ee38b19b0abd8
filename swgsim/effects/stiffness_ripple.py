"""Effect: stiffness that depends on the angle of the wave generator."""

from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class StiffnessRipple(Effect):
    """As the lobes pass, the stiffness of eq. (2) varies by 1 + e cos(order phi_in + phase) (physics.md DY8).

    Signature: the order in the output torque, so in all gauges alike, growing with the load; largest near the
    resonance. A kinematic error, which grows with the load by far less, is a near double at a single load. Typical:
    0.02, an estimate.

    Attributes
    ----------
    order : int
        Waves per revolution, from 2 to 4.
    share : float
        e, from 0 to 0.2.
    phase : float
        [rad].
    """

    place = "drive"
    order: int = choice(low=2, high=4)
    share: float = size(unit="-", low=0, high=0.2, typical=0.02)
    phase: float = phase()

    def drive(self, now: Instant) -> Extra:
        """The stiffness at the angle of the wave generator."""
        return Extra(T_stiff=self.share * now.T_stiff * np.cos(self.order * now.phi_in + self.phase))
