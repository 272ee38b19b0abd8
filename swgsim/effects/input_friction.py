"""Effect: friction at the input that depends on the angle of the wave generator."""

from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import choice, phase, size
from swgsim.effects.sense import sense


@dataclass(frozen=True)
class InputFriction(Effect):
    """Seals and the bearing of the wave generator drag more at some of its angles than at others, behind the torque
    flange (physics.md DY5, DY13); order 1 is that of an unbalance.

    Signature: the order in the speed, and in the input torque the share of it that the inertia before the flange makes;
    the same at every load, gauges all but untouched. Typical: 3 to 10 % of the running torque without load, 3 mN m.

    Attributes
    ----------
    order : int
        Waves per revolution, from 2 to 4.
    amplitude : float
        [N m], from 0 to 0.05, which is all of that torque.
    phase : float
        [rad].
    """

    place = "drive"
    order: int = choice(low=2, high=4)
    amplitude: float = size(unit="N m", low=0, high=0.05, typical=3e-3)
    phase: float = phase()

    def drive(self, now: Instant) -> Extra:
        """The torque against the rotation at the angle of the wave generator."""
        return Extra(T_loss=sense(now.omega_in) * self.amplitude * np.cos(self.order * now.phi_in + self.phase))
