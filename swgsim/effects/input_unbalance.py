from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import phase, size


@dataclass(frozen=True)
class InputUnbalance(Effect):
    """Gravity turns an unbalanced wave generator on a level axis; it brakes by amplitude cos(phi_in + phase).

    It also stands for run-out of a seal or an Oldham coupling behind the torque flange (an estimate; physics.md DY13).

    Signature: that of motor torque ripple of order 1, except for the input torque, which shows only the answer of the
    speed control. Typical: 1 mN m, 10 g at 10 mm.

    Attributes
    ----------
    amplitude : float
        Torque at the input [N m], from 0 to 0.02.
    phase : float
        Of the wave at phi_in = 0, the major axis at s1 [rad].
    """

    place = "drive"
    amplitude: float = size(unit="N m", low=0, high=0.02, typical=1e-3)
    phase: float = phase()

    def drive(self, now: Instant) -> Extra:
        """The torque at the angle of the wave generator."""
        return Extra(T_loss=self.amplitude * np.cos(now.phi_in + self.phase))
