from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.quantity import choice, phase, size
from swgsim.gear.gear import Gear, KinematicError


@dataclass(frozen=True)
class KinematicErrorOrder(Effect):
    """Cam, circular spline or their assembly add amplitude sin(order phi_in + phase) to phi_err of eq. (3).

    The source is physics.md DY7.

    Signature: the order in the output torque, so equally in all gauges; s1 to s4 also show the orders n + 2 and n - 2.
    Above the resonance the output stands still, and the ripple is stiffness times error at any speed. It grows with the
    load, as the gear stiffens. Typical: 0.2e-4 to 1e-4 rad; the catalogue allows 4.4e-4 rad peak to peak.

    Attributes
    ----------
    order : int
        Waves per revolution of the wave generator, from 1 to 8.
    amplitude : float
        At the output [rad], from 0 to 4.4e-4, twice what the catalogue allows.
    phase : float
        Of the sine at phi_in = 0, the major axis at s1 [rad].
    """

    place = "gear"
    order: int = choice(low=1, high=8)
    amplitude: float = size(unit="rad", low=0, high=4.4e-4, typical=0.5e-4)
    phase: float = phase()

    def gear(self, gear: Gear) -> Gear:
        """The gear with one more term of the kinematic error."""
        transmission = gear.transmission
        terms = (*transmission.kinematic_error, KinematicError(self.order, self.amplitude, self.phase))
        return gear.with_transmission(kinematic_error=terms)
