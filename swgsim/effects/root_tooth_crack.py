"""Fault: root tooth crack."""

from dataclasses import dataclass

from swgsim.effects.base import Crack, Effect
from swgsim.effects.quantity import angle, size


@dataclass(frozen=True)
class RootToothCrack(Effect):
    """A crack at the root of a tooth: the stiffness between two neighbouring nodes drops (section II-B).

    Signature: a local hinge in the rim; even orders of all gauges change in amplitude and phase, locked to the position
    of the crack. The bars that cross the gap are weakened, the diagonal ones as well: with the circumferential ones
    alone, as in the paper, the gauges hardly notice (docs/chain.md).

    Attributes
    ----------
    stiffness_ratio : float
        Remaining stiffness of one tooth pitch of the rim, from 0.001 (torn through) to 1.
    theta : float
        Position of the crack [rad]; the crack is in the gap of the mesh that begins at or holds this angle.
    """

    place = "structure"
    stiffness_ratio: float = size(unit="-", low=1e-3, high=1, typical=0.1, nothing=1)
    theta: float = angle()

    def cracks(self) -> tuple[Crack, ...]:
        """The one crack."""
        return (Crack(self.theta, self.stiffness_ratio),)
