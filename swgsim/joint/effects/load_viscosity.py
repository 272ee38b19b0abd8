"""Effect: viscous friction that grows with the load."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term


@dataclass(frozen=True)
class LoadViscosity(Term):
    """Viscous friction in proportion to the load, c |T| omega, as more balls and flanks carry (an estimate of form).

    Signature: load friction that rises with speed.
    """

    needs = ("omega", "T_rigid")

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Size of the load times the speed."""
        return (np.abs(recording.signals["T_rigid"]) * recording.speed)[:, None]

    def units(self, of: str) -> tuple[str, ...]:
        """Of c."""
        return (f"{of} s/(N m rad)",)

    @property
    def sound(self) -> bool:
        """Friction brakes."""
        return all(weight > 0 for weight in self.weights)
