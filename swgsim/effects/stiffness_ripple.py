from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class StiffnessRipple(Effect):
    """As the lobes pass, the stiffness of eq. (2) varies by 1 + share cos(order phi_in + phase) (physics.md DY8).

    Signature: the order in the output torque, so equally in all gauges. It grows with the load and is largest near the
    resonance. A kinematic error grows far less with the load, but at a single load it is nearly the same. Typical:
    0.02, an estimate.

    Attributes
    ----------
    order : int
        Waves per revolution, from 2 to 4.
    share : float
        e, from 0 to 0.2.
    phase : float
        Of the wave at phi_in = 0, the major axis at s1 [rad].
    """

    place = "drive"
    order: int = choice(low=2, high=4)
    share: float = size(unit="-", low=0, high=0.2, typical=0.02)
    phase: float = phase()

    def drive(self, now: Instant) -> Extra:
        """The stiffness at the angle of the wave generator."""
        return Extra(T_stiff=self.share * now.T_stiff * np.cos(self.order * now.phi_in + self.phase))
