from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class MotorTorqueRipple(Effect):
    """Cogging, current offsets and the controller add amplitude cos(order phi_in + phase) to the motor's torque.

    The source is physics.md DY9.

    Signature: the order in the input torque, with its full amplitude above the bandwidth of the speed control. In the
    speed it falls with order and speed. It is equal at every load, and the gauges hardly change. Typical: 1 to 3 % of
    the motor's torque, 0.01 N m; orders 1, 2, the number of pole pairs and six times it.

    Attributes
    ----------
    order : int
        Waves per revolution of the input, from 1 to 12.
    amplitude : float
        [N m], from 0 to 0.1, beyond which the speed would ripple by per cents.
    phase : float
        Of the wave at phi_in = 0, the major axis at s1 [rad].
    """

    place = "drive"
    order: int = choice(low=1, high=12)
    amplitude: float = size(unit="N m", low=0, high=0.1, typical=0.01)
    phase: float = phase()

    def drive(self, now: Instant) -> Extra:
        """The motor's additional torque."""
        return Extra(T_motor=self.amplitude * np.cos(self.order * now.phi_in + self.phase))
