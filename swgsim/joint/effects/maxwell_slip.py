"""Effect: friction that builds up over a distance when the motion turns."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import shape
from swgsim.joint.kinematics import play
from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term

# Each element slips at so many times the distance of the one before.
NEXT, ELEMENTS = 5.0, 2
# An element below this share of the larger one is none, whatever its sign.
ABSENT = 0.1


@dataclass(frozen=True)
class MaxwellSlip(Term):
    """Hysteresis and lost motion: flex spline, seals and grease give way elastically before they slip, so that friction
    follows the distance since the last turn and not the speed (Maxwell slip; physics.md DY1, DY12).

    Two elements, the second slips at five times the distance of the first.

    Attributes
    ----------
    distance : float
        At which the first element slips [rad], from 2e-4 to 0.05.
    """

    needs = ("q",)
    distance: float = shape(2e-3, unit="rad", low=2e-4, high=5e-2, points=8)

    @classmethod
    def title(cls) -> str:
        """With the capital of a person's name."""
        return "Maxwell slip"

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Strain of each element, as a share of that at which it slips."""
        q = recording.signals["q"]
        return np.stack([play(q, self.distance * NEXT**number) for number in range(ELEMENTS)], axis=1)

    def units(self, of: str) -> tuple[str, ...]:
        """Friction of each element."""
        return (of,) * ELEMENTS

    @property
    def sound(self) -> bool:
        """Friction brakes; one of the elements may be all but absent."""
        return min(self.weights) > -ABSENT * max(self.weights)
