from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import size

# Width of the smooth ends of the gap, as a share of it.
END = 0.05


@dataclass(frozen=True)
class LostMotion(Effect):
    """Worn flanks leave a gap: the stiffness carries no torque while the twist crosses it (physics.md DY12).

    The twist counts from the loaded flank, as no channel shows the position of the output. Above the gap T_stiff is
    that of eq. (2), in the gap zero, and below it that of the twist plus the gap. There the secant stiffness is used,
    which is exact except for the cubic term of a small twist.

    Signature: none while the load keeps the flank, which the default gear's own friction does even without load.
    Impacts at many orders appear where the torque ripple changes the sign of T_stiff: without load near the resonance.
    Typical: 0.2 to 3 arcmin in all.

    Attributes
    ----------
    half_gap : float
        As an angle at the output [rad], from 0 to 5e-4, which is 1.7 arcmin.
    """

    place = "drive"
    half_gap: float = size(unit="rad", low=0, high=5e-4, typical=1e-4)

    def drive(self, now: Instant) -> Extra:
        """What the gap takes from the stiffness."""
        if not self.half_gap:
            return Extra()
        sin_t = now.omega_out / now.sliding  # eq. (6)
        gap = 2 * self.half_gap * np.sqrt(1 - sin_t**2) / sin_t
        into = -now.twist / gap / END
        crossed = END * (np.logaddexp(0, into) - np.logaddexp(0, into - 1 / END))
        secant = np.divide(now.T_stiff, now.twist, out=np.zeros_like(now.twist), where=now.twist != 0)
        return Extra(T_stiff=secant * gap * crossed)
