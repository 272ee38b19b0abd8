from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import choice, phase, size
from swgsim.effects.sense import sense


@dataclass(frozen=True)
class InputFriction(Effect):
    """Seals and the bearing of the wave generator drag more at some angles of the wave generator than at others.

    The torque amplitude cos(order phi_in + phase) brakes the input behind the torque flange (physics.md DY5, DY13).
    Order 1 is the effect input unbalance.

    Signature: the order in the speed. In the input torque it shows with the share of the inertia before the flange. It
    is equal at every load, and the gauges hardly change. Typical: 3 to 10 % of the running torque without load, 3 mN m.

    Attributes
    ----------
    order : int
        Waves per revolution, from 2 to 4.
    amplitude : float
        [N m], from 0 to 0.05, which is all of that torque.
    phase : float
        Of the wave at phi_in = 0, the major axis at s1 [rad].
    """

    place = "drive"
    order: int = choice(low=2, high=4)
    amplitude: float = size(unit="N m", low=0, high=0.05, typical=3e-3)
    phase: float = phase()

    def drive(self, now: Instant) -> Extra:
        """The torque against the rotation at the angle of the wave generator."""
        return Extra(T_loss=sense(now.omega_in) * self.amplitude * np.cos(self.order * now.phi_in + self.phase))
