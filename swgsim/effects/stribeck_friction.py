from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import shape, size
from swgsim.effects.sense import sense


@dataclass(frozen=True)
class StribeckFriction(Effect):
    """At low speed no film carries the flanks, so T_fric rises by b_s exp(-(v / v_s)^2) (physics.md DY2).

    The sliding speed v is that of eq. (6). At 100, 500, 2000 and 4000 rpm it is 0.21, 1.0, 4.1 and 8.3 rad/s for a
    ratio of 100. With the typical v_s the effect therefore shows below 500 rpm.

    Signature: more input torque at low speed, equally at every load, and none at high speed. Two speeds of 2000 rpm and
    more cannot separate it from b0, or do not show it. Typical: static friction is 1.0 to 1.5 times the kinetic one b0.

    Attributes
    ----------
    b_s : float
        Friction at standstill beyond b0 [N m], from 0 to 0.7, half of b0; with more, slow running would be unstable.
    v_s : float
        Sliding speed at which 37 % of it are left [rad/s], from 0.5 to 3; an estimate.
    """

    place = "drive"
    b_s: float = size(unit="N m", low=0, high=0.7, typical=0.35)
    v_s: float = shape(1.0, unit="rad/s", low=0.5, high=3, points=4)

    def drive(self, now: Instant) -> Extra:
        """The friction of thin films."""
        return Extra(T_fric=sense(now.sliding) * self.b_s * np.exp(-((now.sliding / self.v_s) ** 2)))
