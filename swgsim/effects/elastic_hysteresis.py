from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import size


@dataclass(frozen=True)
class ElasticHysteresis(Effect):
    """Flex spline and its joints lose a share of the energy that each cycle of the twist stores, at any speed.

    T_stiff gains h K d(twist) / d(2 phi_in), with the secant stiffness K of eq. (2) (physics.md FS17, DY1). The loss
    factor h holds for order 2, at which the ellipse works the flex spline; order 1 has half of it and order 4 twice as
    much. The torque follows the change of the twist, not its sign: h abs(T_stiff) times the sign would brake a small
    ripple about a large load as strongly as a twist through the whole load.

    Signature: smaller torque ripple near the resonance and a phase lag, equally in all gauges. Mean torques hardly
    change; the drag of the turning ellipse is seal friction and bearing friction. Typical: 0.02, an estimate.

    Attributes
    ----------
    h : float
        Loss factor, from 0 to 0.1.
    """

    place = "drive"
    h: float = size(unit="-", low=0, high=0.1, typical=0.02)

    def drive(self, now: Instant) -> Extra:
        """The torque that lags behind the twist."""
        secant = np.divide(now.T_stiff, now.twist, out=np.zeros_like(now.twist), where=now.twist != 0)
        return Extra(T_stiff=self.h * secant * now.twist_rate / (2 * now.omega_in))
