from dataclasses import dataclass

from swgsim.effects.base import Effect
from swgsim.effects.quantity import size
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class StiffeningSpring(Effect):
    """The cubic stiffness k2 of eq. (2) differs from that of the nominal gear (physics.md DY1).

    Signature: the torque ripple that the kinematic error excites changes at high load and hardly at low load, where a
    change of k1 shows. Typical: 30 %, an estimate; catalogues give K3 = 1.6 K1.

    Attributes
    ----------
    share : float
        Change of k2 as a share, from -1 (no stiffening) to 2.
    """

    place = "gear"
    share: float = size(unit="-", low=-1, high=2, typical=0.3)

    def gear(self, gear: Gear) -> Gear:
        """The gear with another cubic stiffness."""
        return gear.with_transmission(k2=gear.transmission.k2 * (1 + self.share))
