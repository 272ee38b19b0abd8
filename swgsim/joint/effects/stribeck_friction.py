"""Effect: friction that rises at low speed."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import shape
from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term


@dataclass(frozen=True)
class StribeckFriction(Term):
    """Where speed no longer carries the flanks on a film, friction rises by b_s exp(-(omega / v_s)^2) (physics.md DY2),
    as the effect Stribeck friction of the chain, in the speed of the output.

    Attributes
    ----------
    v_s : float
        Speed at which 37 % of it are left [rad/s], from 0.02 to 0.5.
    """

    v_s: float = shape(0.1, unit="rad/s", low=0.02, high=0.5, points=7)

    @classmethod
    def title(cls) -> str:
        """With the capital of a person's name."""
        return "Stribeck friction"

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """The friction of thin films."""
        return (recording.sense * np.exp(-((recording.speed / self.v_s) ** 2)))[:, None]

    def units(self, of: str) -> tuple[str, ...]:
        """Of b_s."""
        return (of,)

    @property
    def sound(self) -> bool:
        """Friction rises at low speed."""
        return all(weight > 0 for weight in self.weights)
