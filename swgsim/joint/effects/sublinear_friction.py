"""Effect: friction that grows slower than the speed."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import shape
from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term


@dataclass(frozen=True)
class SublinearFriction(Term):
    """Grease that is churned, or thinned by shear: c |omega|^p beside the viscous friction; 2/3 after Palmgren, as in
    the effect churning loss of the chain.

    Attributes
    ----------
    power : float
        From 0.2 to 0.7; near 0 and near 1 it is Coulomb and viscous friction.
    """

    power: float = shape(2 / 3, unit="-", low=0.2, high=0.7, points=5)

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """The power of the speed, with the sense of the friction."""
        return (recording.sense * np.abs(recording.speed) ** self.power)[:, None]

    def units(self, of: str) -> tuple[str, ...]:
        """Of c."""
        return (f"{of} (s/rad)^p",)

    @property
    def sound(self) -> bool:
        """Friction rises with speed."""
        return all(weight > 0 for weight in self.weights)
