"""Effect: friction that differs between the directions of motion."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term


@dataclass(frozen=True)
class AsymmetricFriction(Term):
    """Coulomb and viscous friction that are larger in one direction: flanks and seals that were run in one way
    (physics.md DY6: 14 % in one drive). Half the difference in each.

    Signature: a residual that keeps its sign when the motion turns; at rest there is none.
    """

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """That of each friction which does not change its sign."""
        return np.stack([np.abs(recording.sense), np.abs(recording.speed)], axis=1)

    def units(self, of: str) -> tuple[str, ...]:
        """Of the two halves."""
        return of, f"{of} s/rad"
