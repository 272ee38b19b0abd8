from dataclasses import dataclass

from swgsim.effects.base import Effect, Extra, Instant
from swgsim.effects.quantity import size
from swgsim.effects.sense import sense


@dataclass(frozen=True)
class SealFriction(Effect):
    """Seals, motor bearings or an Oldham coupling brake the input by a constant torque (physics.md DY13).

    Signature: a higher input torque, by the same amount at every speed and load; the gauges do not change. A higher b0
    is nearly the same, but acts behind the gear ratio and also brakes the flanks. Typical: 5 to 20 mN m.

    Attributes
    ----------
    T : float
        At the input [N m], from 0 to 0.1, twice the running torque of the gear without load.
    """

    place = "drive"
    T: float = size(unit="N m", low=0, high=0.1, typical=0.01)

    def drive(self, now: Instant) -> Extra:
        """The torque against the rotation."""
        return Extra(T_loss=self.T * sense(now.omega_in))
