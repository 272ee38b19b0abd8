from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import choice, phase, size
from swgsim.gear.gear import Transmission

# Inertia that the drive moves along [kg m^2]: that of the default gear.
J_IN = Transmission().J_in


@dataclass(frozen=True)
class SpeedRipple(Effect):
    """The drive turns unevenly, n (1 + share cos(order phi_in + phase)), by a faulty resolver or speed control.

    The effect adds the torque that this takes on the inertia of the input (physics.md DY9).

    Signature: the order in the speed, in proportion to it, and in the input torque with the square of the speed, at
    every load; the gauges hardly change. A motor torque ripple is one torque at every speed. Typical: 0.1 to 1 %.

    Attributes
    ----------
    order : int
        Waves per revolution of the input, from 1 to 12.
    share : float
        Of the speed, from 0 to 0.03, beyond which drives trip; above the bandwidth of the speed control.
    phase : float
        Of the wave at phi_in = 0, the major axis at s1 [rad].
    """

    place = "drive"
    order: int = choice(low=1, high=12)
    share: float = size(unit="-", low=0, high=0.03, typical=1e-3)
    phase: float = phase()

    def drive(self, now: Instant) -> Extra:
        """The motor's torque that makes the speed uneven."""
        swing = self.share * self.order * now.omega_in**2
        return Extra(T_motor=-J_IN * swing * np.sin(self.order * now.phi_in + self.phase))
