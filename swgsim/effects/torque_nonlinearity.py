from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Scene, Signals
from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.quantity import choice, size

# Mean signal per torque of the default gear [mV/V per N m]: the all-round bridge has twice the arms.
SENSITIVITY = 1.622e-3 * np.array([[2.0], [1.0], [1.0], [1.0], [1.0]])


@dataclass(frozen=True)
class TorqueNonlinearity(Effect):
    """Collar and clamp stiffen or soften: the part S T of each signal gains share (abs(T) / 70 N m)^(power - 1).

    The source is physics.md SE9. The part is computed from the transmitted torque and the nominal sensitivity S,
    because s1 to s4 do not show it separately.

    Signature: means of all gauges grow as T^power, s0 twice as much as the others. The torque ripple in them grows by
    power times the share, most visibly in s0. The part by the wave generator stays. Typical: 0.5 to 1 % (a linearity of
    0.9997 is published).

    Attributes
    ----------
    share : float
        At 70 N m, from -0.1 to 0.1 (beyond, the collar would yield).
    power : int
        Of the torque in what is added, 2 or 3.
    """

    place = "gauge"
    share: float = size(unit="-", low=-0.1, high=0.1, typical=0.005)
    power: int = choice(2, low=2, high=3)

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The signals plus what the torque adds out of proportion."""
        added = self.share * (np.abs(scene.T_out) / FULL_LOAD) ** (self.power - 1)
        return signals + added * SENSITIVITY * scene.T_out
