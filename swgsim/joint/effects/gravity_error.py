"""Effect: gravity pulls otherwise than the rigid-body model says."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term


@dataclass(frozen=True)
class GravityError(Term):
    """A payload, a cable or a centre of gravity that the rigid-body model does not know: cosine and sine of the angle
    of every link about parallel level axes (exact for a planar chain).

    For a joint that is not among them, or if the posture is unknown: cosine and sine of its own angle.

    Signature: a residual that depends on the posture, whichever way the joint turns and however fast.
    """

    explains = ("current", "T_sensor")
    needs = ("q", "T_rigid")

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Cosine and sine of the angle of each link against the first one's base."""
        angles, _ = recording.links
        return np.concatenate([np.cos(angles), np.sin(angles)]).T

    def units(self, of: str) -> tuple[str, ...]:
        """That of the signal, for every column."""
        return (of,)
