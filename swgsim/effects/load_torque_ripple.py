from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import choice, phase, size
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint


@dataclass(frozen=True)
class _Ripple(Effect):
    """The ripple at one load, its amplitude in [N m]."""

    order: int
    amplitude: float
    phase: float

    def drive(self, now: Instant) -> Extra:
        return Extra(T_load=self.amplitude * np.cos(self.order * now.phi_in + self.phase))


@dataclass(frozen=True)
class LoadTorqueRipple(Effect):
    """The brake does not hold its torque: the load gains share T_out cos(order phi_in + phase) (physics.md DY10).

    Signature: the order in the output torque, so equally in all gauges, in proportion to the load. It is largest near
    the resonance and falls with speed above, as the load's inertia takes the ripple. Typical: 0.5 to 3 % of the load.

    Attributes
    ----------
    order : int
        Waves per revolution of the wave generator, from 1 to 4.
    share : float
        Of the load that is set, from 0 to 0.1.
    phase : float
        Of the wave at phi_in = 0, the major axis at s1 [rad].
    """

    place = "drive"
    order: int = choice(low=1, high=4)
    share: float = size(unit="-", low=0, high=0.1, typical=0.02)
    phase: float = phase()

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The ripple at the load that is set."""
        return _Ripple(self.order, self.share * point.T_out, self.phase)
