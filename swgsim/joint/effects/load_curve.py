"""Effect: a motor or a spring that answers the load along a curve."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term


@dataclass(frozen=True)
class LoadCurve(Term):
    """The signal is not in proportion to the load, a T |T| + b T^3: iron that saturates, a bridge that is not
    linear (an estimate of form).

    Signature: a residual in phase with the load, whichever way the joint turns.
    """

    explains = ("current", "T_sensor")
    needs = ("T_rigid",)

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Second and third power of the load."""
        load = recording.signals["T_rigid"]
        return np.stack([load * np.abs(load), load**3], axis=1)

    def units(self, of: str) -> tuple[str, ...]:
        """Of a and b."""
        return f"{of}/(N m)^2", f"{of}/(N m)^3"
