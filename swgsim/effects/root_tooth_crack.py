"""Fault: root tooth crack."""

from dataclasses import dataclass

from swgsim.checks import require
from swgsim.effects.base import Crack, Effect


@dataclass(frozen=True)
class RootToothCrack(Effect):
    """A crack at the root of a tooth: the hoop stiffness between two neighbouring nodes drops (section II-B).

    Signature: a local hinge in the rim; the amplitudes of all gauges change with the lobe's passage over the crack,
    even and odd orders, phase-locked to the crack.

    Attributes
    ----------
    stiffness_ratio : float
        Remaining stiffness of one tooth pitch of the rim, from 0.001 (torn through) to 1.
    theta : float
        Position of the crack [rad].
    """

    stiffness_ratio: float
    theta: float

    def __post_init__(self) -> None:
        require("the root tooth crack", "stiffness_ratio", self.stiffness_ratio, low=1e-3, high=1)
        require("the root tooth crack", "theta", self.theta)

    def cracks(self) -> tuple[Crack, ...]:
        """The one crack."""
        return (Crack(self.theta, self.stiffness_ratio),)
