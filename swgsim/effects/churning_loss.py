from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import size
from swgsim.effects.sense import sense

# Input speed at which the size is given, 2000 rpm [rad/s].
RATED_SPEED = 2000 * 2 * np.pi / 60


@dataclass(frozen=True)
class ChurningLoss(Effect):
    """The bearing of the wave generator churns its grease and brakes the input by T (n / 2000 rpm)^(2/3).

    The law is Palmgren's (physics.md section 2.2).

    Signature: input torque that grows slower than speed and is equal at every load; the gauges hardly change. Two
    speeds cannot separate it from a constant plus a viscous loss. Typical: 0.02 N m. Churning and seals take about 60 %
    of the 51 mN m that the gear needs without load.

    Attributes
    ----------
    T : float
        At the input at 2000 rpm [N m], from 0 to 0.1, twice the running torque of the gear without load.
    """

    place = "drive"
    T: float = size(unit="N m", low=0, high=0.1, typical=0.02)

    def drive(self, now: Instant) -> Extra:
        """The torque against the rotation."""
        return Extra(T_loss=self.T * sense(now.omega_in) * np.abs(now.omega_in / RATED_SPEED) ** (2 / 3))
