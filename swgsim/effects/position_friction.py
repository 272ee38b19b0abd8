from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import choice, phase, size
from swgsim.effects.sense import sense


@dataclass(frozen=True)
class PositionFriction(Effect):
    """A flank or lobe is tighter: the friction of eq. (5) gains amplitude cos(order phi_in + phase).

    The source is physics.md DY5.

    Signature: the order in the output torque, so equally in all gauges. Above the resonance it is amplitude /
    sin(alpha_tooth) at every load and speed. A kinematic error of the same order grows with the load. Typical: 3 to 10
    % of the friction.

    Attributes
    ----------
    order : int
        Waves per revolution, from 1 to 4.
    amplitude : float
        [N m], from 0 to 1.4, which is all of b0.
    phase : float
        Of the wave at phi_in = 0, the major axis at s1 [rad].
    """

    place = "drive"
    order: int = choice(low=1, high=4)
    amplitude: float = size(unit="N m", low=0, high=1.4, typical=0.15)
    phase: float = phase()

    def drive(self, now: Instant) -> Extra:
        """The friction at the angle of the wave generator."""
        return Extra(T_fric=sense(now.sliding) * self.amplitude * np.cos(self.order * now.phi_in + self.phase))
