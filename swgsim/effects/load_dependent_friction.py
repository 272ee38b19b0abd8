from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.flank_friction import FlankFriction
from swgsim.effects.quantity import size
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint

# Rated torque of a size 17, ratio 100 gear [N m], at which mu holds.
RATED = 31.0


@dataclass(frozen=True)
class LoadDependentFriction(Effect):
    """Load thins the film between the flanks, so mu is multiplied by 1 + c (T_out / 31 N m - 1).

    This is the first term of any law mu(T) about the rated torque, for which mu holds (physics.md DY4).

    Signature: input torque that is curved over the load, with no change at 31 N m. The torque ripple changes slightly
    in the opposite sense. Typical: 0.1, an estimate; mu from 0.05 to 0.12 over all loads.

    Attributes
    ----------
    c : float
        Rise of mu, as a share, per rated torque, from -0.15 to 0.5; beyond, mu would leave the bounds of flank friction
        at the momentary peak torque of 143 N m.
    """

    place = "gear"
    c: float = size(unit="-", low=-0.15, high=0.5, typical=0.1)

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The friction coefficient at the load that is set."""
        return FlankFriction(1 + self.c * (point.T_out / RATED - 1))
