"""Imperfection: strain that is not in proportion to torque."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.quantity import choice, size

# Mean signal per torque of the default gear [mV/V per N m]: the all-round bridge has twice the arms.
SENSITIVITY = 1.622e-3 * np.array([[2.0], [1.0], [1.0], [1.0], [1.0]])


@dataclass(frozen=True)
class TorqueNonlinearity(Effect):
    """Collar and clamp stiffen or soften under torque: the torque's part of every signal, S T, gains share
    (|T| / 70 N m)^(power - 1) of itself (physics.md SE9).

    Signature: means of all gauges grow as T^power, s0 twice as much as the others; the torque ripple in them grows by
    power times the share, best seen in s0; the part by the wave generator stays. The torque's part is taken from
    the transmitted torque and the nominal sensitivity, since the signals of s1 to s4 do not show it by itself.
    Typical: 0.5 to 1 % (a linearity of 0.9997 is published).

    Attributes
    ----------
    share : float
        At 70 N m, up to 0.1 (beyond, the collar would yield) both ways.
    power : int
        Of the torque in what is added, 2 or 3.
    """

    place = "gauge"
    share: float = size(unit="-", low=-0.1, high=0.1, typical=0.005)
    power: int = choice(2, low=2, high=3)

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals plus what the torque adds out of proportion."""
        added = self.share * (np.abs(scene.T_out) / FULL_LOAD) ** (self.power - 1)
        return signals + added * SENSITIVITY * scene.T_out
