"""Fault: root tooth crack."""

from dataclasses import dataclass

from swgsim.checks import require
from swgsim.effects.base import Crack, Effect


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

    stiffness_ratio: float
    theta: float

    def __post_init__(self) -> None:
        require("the root tooth crack", "stiffness_ratio", self.stiffness_ratio, low=1e-3, high=1)
        require("the root tooth crack", "theta", self.theta)

    def cracks(self) -> tuple[Crack, ...]:
        """The one crack."""
        return (Crack(self.theta, self.stiffness_ratio),)
