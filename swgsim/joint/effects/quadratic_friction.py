"""Effect: friction that grows faster than the speed."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term


@dataclass(frozen=True)
class QuadraticFriction(Term):
    """Friction with the square of the speed, c omega^2, beside the viscous one: grease that is thrown, the cubic part
    of eq. (5) over a range of speeds (an estimate of form).
    """

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """The square of the speed, with the sense of the friction."""
        return (recording.sense * recording.speed**2)[:, None]

    def units(self, of: str) -> tuple[str, ...]:
        """Of c."""
        return (f"{of} s^2/rad^2",)

    @property
    def sound(self) -> bool:
        """Friction rises with speed."""
        return all(weight > 0 for weight in self.weights)
