"""Effect: friction that rises at low speed."""

from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import shape, size
from swgsim.effects.sense import sense


@dataclass(frozen=True)
class StribeckFriction(Effect):
    """Where speed no longer carries the flanks on a film, T_fric rises by b_s exp(-(v / v_s)^2) (physics.md DY2).

    Signature: more input torque at low speed, at every load alike, and none at high speed. At 100, 500, 2000 and
    4000 rpm the flanks of a gear of ratio 100 slide at 0.21, 1.0, 4.1 and 8.3 rad/s, eq. (6): below 500 rpm the typical
    v_s shows; from two speeds of 2000 rpm and more it cannot be told from b0, or it is not there at all.
    Typical: static friction is 1.0 to 1.5 times the kinetic one b0.

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
