"""Effect: more inertia than the rigid-body model says."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term


@dataclass(frozen=True)
class InertiaError(Term):
    """Inertia that the rigid-body model does not know, J domega/dt: that of the motor, seen through the gear, or of a
    payload (eq. (1)).
    """

    needs = ("omega", "T_rigid")

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """The acceleration."""
        return recording.acceleration[:, None]

    def units(self, of: str) -> tuple[str, ...]:
        """Of J."""
        return (f"{of} s^2/rad",)
