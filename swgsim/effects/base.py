"""The idea of an effect: what it may change, and that it changes nothing else."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.gear import Gear


@dataclass(frozen=True)
class Crack:
    """The bars of the toothed band that cross from one sector to the next lost stiffness.

    Attributes
    ----------
    angle : float
        Circumferential position of the crack [rad].
    stiffness_ratio : float
        Remaining stiffness of one tooth pitch of the rim, above 0 up to 1.
    """

    angle: float
    stiffness_ratio: float


@dataclass(frozen=True)
class Effect:
    """A physical effect; a subclass overrides only the places of the chain that it touches.

    The methods of this base class change nothing. Fields over the circumference are sampled at the wave-generator
    angles ``psi`` (relative to the flex spline) and at equally spaced angles ``theta`` around it.
    """

    def gear(self, gear: Gear) -> Gear:
        """A gear with changed parameters."""
        return gear

    def wave_generator(
        self,
        displacement: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """Radial displacement [m] that the wave generator imposes on the sleeve."""
        return displacement

    def mesh(
        self,
        share: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """Share of the tangential force that is carried at each angle; the chain scales the shares to sum to one."""
        return share

    def cracks(self) -> tuple[Crack, ...]:
        """Places where the rim lost stiffness."""
        return ()
