from dataclasses import dataclass

from swgsim.effects.base import Crack, Effect
from swgsim.effects.quantity import angle, size


@dataclass(frozen=True)
class RootToothCrack(Effect):
    """A crack at the root of a tooth: the stiffness between two neighbouring columns of nodes falls.

    This is a fault of Table I (section II-B). All bars of the toothed band that cross the gap lose stiffness, also the
    diagonal ones. If only the circumferential bars did, as in the paper, the gauges would hardly notice
    (docs/chain.md). :func:`swgsim.chain.influence.change_by_cracks`
    computes the change of the signals; the truss stays as it is.

    Signature: a local hinge in the rim. Even orders of all gauges change in amplitude and phase, depending on the
    position of the crack.

    Attributes
    ----------
    stiffness_ratio : float
        Remaining stiffness of one tooth pitch of the rim, from 0.001 (torn through) to 1.
    theta : float
        Position of the crack, from gauge s1 in the sense of phi_in [rad]. It is in the gap between sectors
        of the mesh that begins at or holds this angle.
    """

    place = "structure"
    stiffness_ratio: float = size(unit="-", low=1e-3, high=1, typical=0.1, nothing=1)
    theta: float = angle()

    def cracks(self) -> tuple[Crack, ...]:
        """The one crack."""
        return (Crack(self.theta, self.stiffness_ratio),)
