"""Effect: churning of grease."""

from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import size
from swgsim.effects.sense import sense

# Input speed at which the size is given, 2000 rpm [rad/s].
RATED_SPEED = 2000 * 2 * np.pi / 60


@dataclass(frozen=True)
class ChurningLoss(Effect):
    """The wave generator's bearing churns its grease, T (n / 2000 rpm)^(2/3) after Palmgren (physics.md section 2.2).

    Signature: input torque that grows slower than speed, the same at every load; gauges all but untouched. With
    two speeds it cannot be told from a constant and a viscous loss. Typical: 0.02 N m; churning and seals are some
    60 % of the 51 mN m that the gear takes without load.

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
