"""Effect: another order of the kinematic error."""

from dataclasses import dataclass, replace

from swgsim.effects.base import Effect
from swgsim.effects.quantity import choice, phase, size
from swgsim.gear.gear import Gear, KinematicError


@dataclass(frozen=True)
class KinematicErrorOrder(Effect):
    """Cam, circular spline or their assembly add a wave to the kinematic error of eq. (3) (physics.md DY7).

    Signature: the order in the output torque, so in all gauges alike, with order n + 2 and n - 2 in s1 to s4 beside
    it. Above the resonance the output stands still and the ripple is stiffness times error, whatever the speed; it
    grows with the load, as the gear stiffens. Typical: 0.2 to 1e-4 rad; the catalogue allows 4.4e-4 rad peak to peak.

    Attributes
    ----------
    order : int
        Waves per revolution of the wave generator, from 1 to 8.
    amplitude : float
        At the output [rad], from 0 to 4.4e-4, twice what the catalogue allows.
    phase : float
        Of the sine [rad].
    """

    place = "gear"
    order: int = choice(low=1, high=8)
    amplitude: float = size(unit="rad", low=0, high=4.4e-4, typical=0.5e-4)
    phase: float = phase()

    def gear(self, gear: Gear) -> Gear:
        """The gear with one more term of the kinematic error."""
        transmission = gear.transmission
        terms = (*transmission.kinematic_error, KinematicError(self.order, self.amplitude, self.phase))
        return replace(gear, transmission=replace(transmission, kinematic_error=terms))
